#include "orb_slam/loop_candidates.hpp"

#include <algorithm>
#include <utility>

namespace stillpoint::orb_slam {
namespace {

// Consecutive key frames with consistent candidates. ORB-SLAM asks for three, but in a loop of some
// twenty key frames often only two see the place again, and match_loop rejects false candidates.
constexpr int kMinConsistentKeyFrames = 2;
constexpr std::size_t kMaxLoopCandidates = 10;  // per key frame
constexpr double kMinScore = 0.3;  // of the score of the most similar covisible neighbour

// Key frames that tracking and local mapping have in view anyway: two steps of covisibility.
std::vector<bool> neighbours(const SparseMap& map, KeyFrameId centre) {
  std::vector<bool> near(map.keyframe_id_end());
  near[centre] = true;
  for (const Covisibility& c : map.keyframe(centre)->covisible) {
    near[c.keyframe] = true;
    for (const Covisibility& further : map.keyframe(c.keyframe)->covisible)
      near[further.keyframe] = true;
  }
  return near;
}

bool share_keyframe(const std::vector<KeyFrameId>& a, const std::vector<KeyFrameId>& b) {
  return std::ranges::any_of(a, [&](KeyFrameId id) { return std::ranges::binary_search(b, id); });
}

}  // namespace

std::vector<KeyFrameId> LoopCandidates::find(const SparseMap& map, KeyFrameId newest) {
  index_.update(map);
  const KeyFrame* keyframe = map.keyframe(newest);
  if (!keyframe) return {};
  const std::vector<bool> near = neighbours(map, newest);
  const std::vector<PlaceVote> votes = index_.query(place_descriptors(*keyframe));
  double reference_score = 0;  // of the most similar neighbour
  for (const PlaceVote& vote : votes)
    if (near[vote.keyframe] && vote.keyframe != newest)
      reference_score = std::max(reference_score, vote.score);

  std::vector<Group> groups;
  std::vector<KeyFrameId> candidates;
  for (const PlaceVote& vote : votes) {
    if (groups.size() == kMaxLoopCandidates || vote.score < kMinScore * reference_score) break;
    if (near[vote.keyframe]) continue;
    groups.push_back(consistent_group(map, vote.keyframe));
    if (groups.back().seen >= kMinConsistentKeyFrames) candidates.push_back(vote.keyframe);
  }
  groups_ = std::move(groups);
  return candidates;
}

LoopCandidates::Group LoopCandidates::consistent_group(const SparseMap& map,
                                                       KeyFrameId candidate) const {
  Group group{{candidate}};
  for (const Covisibility& c : map.keyframe(candidate)->covisible)
    group.keyframes.push_back(c.keyframe);
  std::ranges::sort(group.keyframes);
  for (const Group& before : groups_)
    if (share_keyframe(group.keyframes, before.keyframes))
      group.seen = std::max(group.seen, before.seen + 1);
  return group;
}

}  // namespace stillpoint::orb_slam
