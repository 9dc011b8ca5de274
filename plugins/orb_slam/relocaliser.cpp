#include "orb_slam/relocaliser.hpp"

#include <algorithm>

#include "orb_slam/appearance.hpp"

namespace stillpoint::orb {
namespace {

constexpr int kNearby = 2;  // candidates per frame around the last known place
constexpr int kAround = 2;  // candidates per frame on the way round the map
constexpr int kMinInliers = 30;

}  // namespace

std::vector<KeyFrameId> Relocaliser::candidates(const SparseMap& map) {
  std::vector<KeyFrameId> result;
  if (const KeyFrame* place = map.keyframe(last_place_)) {
    result.push_back(place->id);
    if (!place->covisible.empty()) result.push_back(place->covisible.front().keyframe);
  }
  result.resize(std::min<std::size_t>(result.size(), kNearby));
  const auto end = static_cast<KeyFrameId>(map.keyframe_id_end());
  for (KeyFrameId step = 0; step < end && result.size() < kNearby + kAround; ++step) {
    next_ = next_ % end;
    const KeyFrameId id = next_++;
    if (map.keyframe(id) && std::find(result.begin(), result.end(), id) == result.end())
      result.push_back(id);
  }
  return result;
}

bool Relocaliser::find(ObservedFrame& frame, const SparseMap& map) {
  for (const KeyFrameId id : candidates(map)) {
    if (locate_by_appearance(frame, targets_of(*map.keyframe(id), map), map) < kMinInliers)
      continue;
    frame.reference = id;
    return true;
  }
  frame.clear_matches();
  return false;
}

}  // namespace stillpoint::orb
