#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint {
namespace {

std::string edge(const char* from, std::uint32_t a, const char* to, std::uint32_t b) {
  return std::string(from) + " " + std::to_string(a) + " -> " + to + " " + std::to_string(b);
}

std::optional<std::string> check_features(const SparseMap& map, const KeyFrame& keyframe) {
  if (keyframe.landmarks.size() != keyframe.features->size())
    return "key frame " + std::to_string(keyframe.id) + ": landmarks and features differ in number";
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    const LandmarkId id = keyframe.landmarks[i];
    if (id == kNoId) continue;
    const std::string link = edge("key frame", keyframe.id, "landmark", id);
    const Landmark* landmark = map.landmark(id);
    if (!landmark) return link + ": landmark is gone";
    bool found = false;
    for (const Observation& o : landmark->observations)
      found |= o.keyframe == keyframe.id && o.feature == i;
    if (!found) return link + ": not among the landmark's observations";
  }
  return std::nullopt;
}

std::optional<std::string> check_graph(const SparseMap& map, const KeyFrame& keyframe) {
  for (const Covisibility& c : keyframe.covisible) {
    const KeyFrame* other = map.keyframe(c.keyframe);
    const std::string link = edge("key frame", keyframe.id, "covisible key frame", c.keyframe);
    if (!other) return link + ": is gone";
    bool found = false;
    for (const Covisibility& back : other->covisible)
      found |= back.keyframe == keyframe.id && back.shared == c.shared;
    if (!found) return link + ": no equal edge back";
  }
  if (keyframe.parent == kNoId) return std::nullopt;
  if (keyframe.parent >= keyframe.id || !map.keyframe(keyframe.parent))
    return edge("key frame", keyframe.id, "parent", keyframe.parent) + ": is gone or newer";
  return std::nullopt;
}

std::optional<std::string> check_landmark(const SparseMap& map, const Landmark& landmark) {
  const std::string name = "landmark " + std::to_string(landmark.id);
  if (landmark.observations.empty()) return name + " has no observation";
  KeyFrameId last = kNoId;
  bool has_reference = false;
  for (const Observation& o : landmark.observations) {
    if (last != kNoId && o.keyframe <= last) return name + ": observations out of order";
    last = o.keyframe;
    has_reference |= o.keyframe == landmark.reference;
    const KeyFrame* keyframe = map.keyframe(o.keyframe);
    const std::string link = edge("landmark", landmark.id, "key frame", o.keyframe);
    if (!keyframe) return link + ": key frame is gone";
    if (o.feature >= keyframe->landmarks.size() || keyframe->landmarks[o.feature] != landmark.id)
      return link + ": the feature has another landmark";
  }
  if (!has_reference) return name + ": reference key frame does not see it";
  return std::nullopt;
}

}  // namespace

LandmarkId SparseMap::current_id(LandmarkId id) const {
  while (id < landmarks_.size() && !landmarks_[id]) id = successor_[id];
  return id < landmarks_.size() ? id : kNoId;
}

Pose SparseMap::world_from_keyframe(KeyFrameId id) const {
  Pose parent_from_keyframe = Pose::Identity();
  while (removed_[id]) {
    parent_from_keyframe = removed_[id]->parent_from_keyframe * parent_from_keyframe;
    id = removed_[id]->parent;
    if (id == kNoId) return parent_from_keyframe;
  }
  return keyframes_[id]->world_from_camera * parent_from_keyframe;
}

std::optional<std::string> SparseMap::check() const {
  for (const auto& keyframe : keyframes_) {
    if (!keyframe) continue;
    if (auto fault = check_features(*this, *keyframe)) return fault;
    if (auto fault = check_graph(*this, *keyframe)) return fault;
  }
  for (const auto& landmark : landmarks_)
    if (landmark)
      if (auto fault = check_landmark(*this, *landmark)) return fault;
  return std::nullopt;
}

}  // namespace stillpoint
