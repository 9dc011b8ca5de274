#include "orb_slam/local_map.hpp"

#include <algorithm>
#include <map>

#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/matcher.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr int kMaxCovisible = 10;  // most covisible ones, added per key frame

std::vector<KeyFrameId> by_votes(const std::vector<LandmarkId>& matched, const SparseMap& map) {
  std::map<KeyFrameId, int> votes;
  for (const LandmarkId id : matched)
    if (const Landmark* landmark = map.landmark(id))
      for (const Observation& o : landmark->observations) ++votes[o.keyframe];
  std::vector<std::pair<int, KeyFrameId>> order;
  for (const auto& [id, count] : votes) order.emplace_back(-count, id);
  std::sort(order.begin(), order.end());
  std::vector<KeyFrameId> keyframes;
  for (const auto& [count, id] : order) keyframes.push_back(id);
  return keyframes;
}

void add_neighbours(const SparseMap& map, std::size_t limit, std::vector<KeyFrameId>& keyframes) {
  const std::size_t voted = keyframes.size();
  for (std::size_t i = 0; i < voted && keyframes.size() < limit; ++i) {
    int added = 0;
    for (const Covisibility& c : map.keyframe(keyframes[i])->covisible) {
      if (added == kMaxCovisible || keyframes.size() == limit) break;
      if (std::find(keyframes.begin(), keyframes.end(), c.keyframe) != keyframes.end()) continue;
      keyframes.push_back(c.keyframe);
      ++added;
    }
  }
}

}  // namespace

LocalMap local_map_around(const std::vector<LandmarkId>& matched, const SparseMap& map,
                          int max_keyframes) {
  LocalMap local;
  local.keyframes = by_votes(matched, map);
  if (local.keyframes.empty()) return local;
  local.reference = local.keyframes.front();
  const auto limit = static_cast<std::size_t>(max_keyframes);
  if (local.keyframes.size() > limit) local.keyframes.resize(limit);
  add_neighbours(map, limit, local.keyframes);

  std::vector<bool> taken(map.landmark_id_end());
  for (const KeyFrameId id : local.keyframes) {
    for (const LandmarkId landmark : map.keyframe(id)->landmarks) {
      if (landmark == kNoId || taken[landmark]) continue;
      taken[landmark] = true;
      local.landmarks.push_back(landmark);
    }
  }
  return local;
}

void search(ObservedFrame& frame, const LocalMap& local, const SparseMap& map, double window,
            std::vector<LandmarkId>& visible) {
  std::vector<bool> matched(map.landmark_id_end());
  for (const LandmarkId id : frame.landmarks)
    if (id != kNoId) matched[id] = true;
  const Pose camera_from_world = frame.world_from_camera.inverse();
  const ScalePyramid pyramid(*frame.features);
  std::vector<Query> queries;
  for (const LandmarkId id : local.landmarks) {
    if (matched[id]) {
      visible.push_back(id);
      continue;
    }
    const auto query =
        predict(*map.landmark(id), camera_from_world, *frame.frame->camera, pyramid, window);
    if (!query) continue;
    visible.push_back(id);
    queries.push_back(*query);
  }
  frame.assign(match_near(queries, *frame.features, frame.grid,
                          [&](std::uint32_t i) { return frame.free(i); }, {.ratio = 0.8}));
}

}  // namespace stillpoint::orb_slam
