#include "orb_slam/relocaliser.hpp"

#include <algorithm>

#include "orb_slam/appearance.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr std::size_t kCandidates = 5;  // per frame, two of them around the last known place
constexpr std::size_t kNewPlaces = 50;  // key frames added to the index per frame; 15 ms
constexpr int kMinRelocalisationInliers = 30;
constexpr double kSupportNear = 0.1, kSupportFarAway = 0.2;
constexpr double kReachMetres = 1.0;
constexpr double kReachSpeed = 2.0;  // m/s

}  // namespace

std::vector<KeyFrameId> Relocaliser::candidates(const ObservedFrame& frame, const SparseMap& map) {
  std::vector<KeyFrameId> result;
  if (const KeyFrame* place = map.keyframe(last_place_)) {
    result.push_back(place->id);
    if (!place->covisible.empty()) result.push_back(place->covisible.front().keyframe);
  }
  places_.update(map, kNewPlaces);
  const auto usable = [&](std::uint32_t i) { return frame.usable(i); };
  for (const PlaceVote& vote : places_.query(place_descriptors(*frame.features, usable))) {
    if (result.size() >= kCandidates) break;
    if (std::ranges::find(result, vote.keyframe) == result.end()) result.push_back(vote.keyframe);
  }
  return result;
}

bool Relocaliser::find(ObservedFrame& frame, const SparseMap& map, const Accept& accept) {
  for (const KeyFrameId id : candidates(frame, map)) {
    if (locate_by_appearance(frame, targets_of(*map.keyframe(id), map), map) <
        kMinRelocalisationInliers)
      continue;
    frame.reference = id;
    if (accept()) return true;
  }
  frame.clear_matches();
  return false;
}

double required_support(double metres, double seconds) {
  return metres <= kReachMetres + kReachSpeed * seconds ? kSupportNear : kSupportFarAway;
}

}  // namespace stillpoint::orb_slam
