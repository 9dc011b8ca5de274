#include <algorithm>
#include <map>
#include <string>

#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint {
namespace {

/// A caller's mistake that would otherwise be a read out of bounds.
Error mistake(const std::string& problem, const std::string& remedy) {
  return {Fault::kStage, problem, "MapEdit", remedy};
}

Error no_element(const std::string& what, std::uint32_t id) {
  return mistake("there is no " + what + " " + (id == kNoId ? "kNoId" : std::to_string(id)),
                 "SparseMap gives null for an element that is gone or never was");
}

auto find_observation(std::vector<Observation>& observations, KeyFrameId keyframe) {
  return std::lower_bound(observations.begin(), observations.end(), keyframe,
                          [](const Observation& o, KeyFrameId id) { return o.keyframe < id; });
}

// Sets, changes or removes (shared = 0) an edge; the strongest edges stay first.
void set_edge(std::vector<Covisibility>& edges, KeyFrameId to, int shared) {
  std::erase_if(edges, [&](const Covisibility& c) { return c.keyframe == to; });
  if (shared == 0) return;
  const auto place = std::find_if(edges.begin(), edges.end(), [&](const Covisibility& c) {
    return c.shared < shared || (c.shared == shared && c.keyframe > to);
  });
  edges.insert(place, {to, shared});
}

std::map<KeyFrameId, int> count_shared(const SparseMap& map, const KeyFrame& keyframe) {
  std::map<KeyFrameId, int> shared;
  for (const LandmarkId id : keyframe.landmarks) {
    if (id == kNoId) continue;
    for (const Observation& o : map.landmark(id)->observations)
      if (o.keyframe != keyframe.id) ++shared[o.keyframe];
  }
  return shared;
}

// Parents are older than their children, which keeps the spanning tree free of cycles.
KeyFrameId strongest_older(const KeyFrame& keyframe) {
  for (const Covisibility& c : keyframe.covisible)
    if (c.keyframe < keyframe.id) return c.keyframe;
  return kNoId;
}

}  // namespace

MapEdit::MapEdit(SparseMap map)
    : map_(std::move(map)),
      own_keyframe_(map_.keyframes_.size()),
      own_landmark_(map_.landmarks_.size()) {}

KeyFrame& MapEdit::keyframe(KeyFrameId id) {
  if (!map_.keyframe(id)) throw no_element("key frame", id);
  auto& slot = map_.keyframes_[id];
  if (!own_keyframe_[id]) {
    slot = std::make_shared<KeyFrame>(*slot);
    own_keyframe_[id] = true;
  }
  return const_cast<KeyFrame&>(*slot);  // made by this edit: nobody else sees it yet
}

Landmark& MapEdit::landmark(LandmarkId id) {
  if (!map_.landmark(id)) throw no_element("landmark", id);
  auto& slot = map_.landmarks_[id];
  if (!own_landmark_[id]) {
    slot = std::make_shared<Landmark>(*slot);
    own_landmark_[id] = true;
  }
  return const_cast<Landmark&>(*slot);  // made by this edit: nobody else sees it yet
}

void MapEdit::add_keyframe(KeyFrame added) {
  if (added.id != map_.keyframes_.size())
    throw mistake("a key frame with id " + std::to_string(added.id) + " is added",
                  "the next id is " + std::to_string(map_.keyframes_.size()));
  if (!added.features)
    throw mistake("a key frame without features is added", "give it an empty Features");
  const std::vector<LandmarkId> landmarks = std::move(added.landmarks);
  added.landmarks.assign(added.features->size(), kNoId);
  added.parent = kNoId;
  added.covisible.clear();
  const KeyFrameId id = added.id;
  map_.keyframes_.push_back(std::make_shared<KeyFrame>(std::move(added)));
  map_.removed_.push_back(nullptr);
  own_keyframe_.push_back(true);
  ++map_.keyframe_count_;
  for (std::uint32_t i = 0; i < landmarks.size(); ++i)
    if (const LandmarkId current = map_.current_id(landmarks[i]); current != kNoId)
      add_observation(current, {id, i});
}

LandmarkId MapEdit::add_landmark(Landmark added) {
  added.id = static_cast<LandmarkId>(map_.landmarks_.size());
  added.observations.clear();
  const LandmarkId id = added.id;
  map_.landmarks_.push_back(std::make_shared<Landmark>(std::move(added)));
  map_.successor_.push_back(kNoId);
  own_landmark_.push_back(true);
  ++map_.landmark_count_;
  return id;
}

bool MapEdit::add_observation(LandmarkId id, Observation observation) {
  const KeyFrame* observer = map_.keyframe(observation.keyframe);
  if (!observer) throw no_element("key frame", observation.keyframe);
  if (observation.feature >= observer->landmarks.size())
    throw mistake(
        "key frame " + std::to_string(observation.keyframe) + " has no feature " +
            std::to_string(observation.feature),
        "features count from 0 to " + std::to_string(observer->landmarks.size()) + " - 1");
  if (observer->landmarks[observation.feature] != kNoId) return false;
  Landmark& seen = landmark(id);
  const auto place = find_observation(seen.observations, observation.keyframe);
  if (place != seen.observations.end() && place->keyframe == observation.keyframe) return false;
  if (seen.observations.empty()) seen.reference = observation.keyframe;
  seen.observations.insert(place, observation);
  keyframe(observation.keyframe).landmarks[observation.feature] = id;
  return true;
}

void MapEdit::remove_observation(LandmarkId id, KeyFrameId from) {
  Landmark& seen = landmark(id);
  const auto place = find_observation(seen.observations, from);
  if (place == seen.observations.end() || place->keyframe != from) return;
  keyframe(from).landmarks[place->feature] = kNoId;
  seen.observations.erase(place);
  if (seen.observations.empty())
    remove_landmark(id);
  else if (seen.reference == from)
    seen.reference = seen.observations.front().keyframe;
}

void MapEdit::remove_landmark(LandmarkId id) {
  const Landmark* removed = map_.landmark(id);
  if (!removed) throw no_element("landmark", id);
  for (const Observation& o : removed->observations)
    keyframe(o.keyframe).landmarks[o.feature] = kNoId;
  map_.landmarks_[id].reset();
  --map_.landmark_count_;
}

void MapEdit::fuse_landmarks(LandmarkId kept, LandmarkId gone) {
  if (!map_.landmark(kept)) throw no_element("landmark", kept);
  if (!map_.landmark(gone)) throw no_element("landmark", gone);
  if (kept == gone)
    throw mistake("landmark " + std::to_string(kept) + " is fused with itself", "name two");
  const std::shared_ptr<const Landmark> old = map_.landmarks_[gone];
  remove_landmark(gone);
  map_.successor_[gone] = kept;
  for (const Observation& o : old->observations) add_observation(kept, o);
  Landmark& heir = landmark(kept);
  heir.visible += old->visible;
  heir.found += old->found;
  heir.static_log_odds += old->static_log_odds;
}

void MapEdit::remove_keyframe(KeyFrameId id) {
  const std::shared_ptr<const KeyFrame> old = map_.shared_keyframe(id);
  if (!old) throw no_element("key frame", id);
  if (old->parent == kNoId)
    throw mistake("key frame " + std::to_string(id) + " is removed, but has no parent",
                  "the oldest one stays; update_covisibility() gives the others a parent");
  for (const LandmarkId landmark : old->landmarks)
    if (landmark != kNoId) remove_observation(landmark, id);
  for (const Covisibility& c : old->covisible) set_edge(keyframe(c.keyframe).covisible, id, 0);
  map_.keyframes_[id].reset();
  --map_.keyframe_count_;

  auto removed = std::make_shared<SparseMap::RemovedKeyFrame>();
  removed->parent = old->parent;
  removed->parent_from_keyframe =
      map_.world_from_keyframe(old->parent).inverse() * old->world_from_camera;
  map_.removed_[id] = std::move(removed);
  for (const auto& other : map_.keyframes_) {
    if (!other || other->parent != id) continue;
    const KeyFrameId heir = strongest_older(*other);
    keyframe(other->id).parent = heir != kNoId ? heir : old->parent;
  }
}

void MapEdit::clear() {
  for (KeyFrameId id = map_.keyframe_id_begin_; id < map_.keyframe_id_end(); ++id) {
    auto removed = std::make_shared<SparseMap::RemovedKeyFrame>();
    removed->parent_from_keyframe = map_.world_from_keyframe(id);
    map_.removed_[id] = std::move(removed);
  }
  std::ranges::fill(map_.keyframes_, nullptr);
  std::ranges::fill(map_.landmarks_, nullptr);
  std::ranges::fill(map_.successor_, kNoId);
  map_.keyframe_count_ = map_.landmark_count_ = 0;
  map_.keyframe_id_begin_ = static_cast<KeyFrameId>(map_.keyframe_id_end());
}

void MapEdit::update_covisibility(KeyFrameId id, int min_shared) {
  if (!map_.keyframe(id)) throw no_element("key frame", id);
  std::map<KeyFrameId, int> shared = count_shared(map_, *map_.keyframe(id));
  const auto strongest =
      std::max_element(shared.begin(), shared.end(),
                       [](const auto& a, const auto& b) { return a.second < b.second; });
  if (strongest != shared.end()) {
    const KeyFrameId keep = strongest->first;
    std::erase_if(shared, [&](const auto& s) { return s.second < min_shared && s.first != keep; });
  }
  const std::vector<Covisibility> before = map_.keyframe(id)->covisible;
  for (const Covisibility& c : before)
    if (!shared.contains(c.keyframe)) set_edge(keyframe(c.keyframe).covisible, id, 0);

  std::vector<Covisibility> edges;
  for (const auto& [other, count] : shared) {
    set_edge(keyframe(other).covisible, id, count);
    edges.push_back({other, count});
  }
  std::stable_sort(edges.begin(), edges.end(),
                   [](const auto& a, const auto& b) { return a.shared > b.shared; });
  KeyFrame& updated = keyframe(id);
  updated.covisible = std::move(edges);
  if (updated.parent == kNoId && id > map_.keyframe_id_begin_) {
    const KeyFrameId parent = strongest_older(updated);
    KeyFrameId previous = id - 1;  // without anything in common: the one before it in time
    while (!map_.keyframes_[previous]) --previous;  // the oldest one is never removed
    updated.parent = parent != kNoId ? parent : previous;
  }
}

SparseMap MapEdit::finish() && { return std::move(map_); }

}  // namespace stillpoint
