#include "orb_slam/loop_match.hpp"

#include <algorithm>
#include <set>

#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/targets.hpp"
#include "stillpoint/support/rigid_motion.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr int kMaxNeighbours = 10;   // most covisible key frames of either end
constexpr int kMinLoopMatches = 20;  // to attempt a pose
constexpr int kMinInliers = 40;      // to accept the loop
// Of the landmarks that should be in view. True loops of runs had 0.31 and more, pairs of views
// of fr1_xyz 0.16 to 0.56; false ones, in rooms that look alike, 0.26 at most.
constexpr double kMinSupport = 0.28;
constexpr int kRansacSamples = 300;  // hypotheses
// Not sensor noise: drift between the landmarks of one part of a map.
constexpr RigidNoise kDrift{.pixel = 2.0, .inverse_depth = 0.02};
constexpr double kWideWindow = 10;   // px
constexpr double kNarrowWindow = 4;  // px

std::vector<KeyFrameId> neighbourhood(const SparseMap& map, KeyFrameId centre) {
  std::vector<KeyFrameId> ids{centre};
  for (const Covisibility& c : map.keyframe(centre)->covisible)
    if (std::ssize(ids) <= kMaxNeighbours) ids.push_back(c.keyframe);
  return ids;
}

// Landmarks of a place that the newer end of the loop does not see.
std::vector<Target> targets_around(const SparseMap& map, KeyFrameId place,
                                   const std::vector<KeyFrameId>& newer) {
  std::vector<bool> taken(map.landmark_id_end());
  for (const KeyFrameId id : newer)
    for (const LandmarkId landmark : map.keyframe(id)->landmarks)
      if (landmark != kNoId) taken[landmark] = true;
  std::vector<Target> targets;
  for (const KeyFrameId id : neighbourhood(map, place))
    for (const Target& target : targets_of(*map.keyframe(id), map)) {
      if (taken[target.landmark]) continue;
      taken[target.landmark] = true;
      targets.push_back(target);
    }
  return targets;
}

std::optional<Pose> camera_from_world(const ObservedFrame& view, std::span<const Target> targets,
                                      const Pose& camera_near_place) {
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < targets.size(); ++i)
    queries.push_back({.id = i, .descriptor = targets[i].descriptor, .angle = targets[i].angle});
  const Features& features = *view.features;
  const auto measured = [&](std::uint32_t i) { return view.usable(i) && features.depth[i] > 0; };
  const std::vector<Match> matches =
      match_anywhere(queries, features, measured,
                     {.max_distance = kStrictDistance, .ratio = 0.8, .consistent_angles = true});
  if (std::ssize(matches) < kMinLoopMatches) return std::nullopt;
  const Camera& camera = *view.frame->camera;
  const Pose near_from_world = camera_near_place.inverse();
  std::vector<RigidMatch> points;
  for (const Match& m : matches) {
    const cv::Point2f pixel = features.keypoints[m.feature].pt;
    points.push_back({near_from_world * targets[m.id].point_in_world,
                      camera.unproject(pixel.x, pixel.y, features.depth[m.feature]),
                      {pixel.x, pixel.y}});
  }
  const auto motion = find_rigid_motion(points, camera, kDrift, {}, kRansacSamples, 1);
  if (!motion || motion->inliers < kMinLoopMatches) return std::nullopt;
  return motion->target_from_source * near_from_world;
}

struct Refined {
  int inliers = 0;
  int visible = 0;  // landmarks that should be in view
};

// Matching guided by where and how large the landmarks should appear, then the pose from the
// matches. The camera may be nearer or farther away than the place's was.
Refined refine(ObservedFrame& view, std::span<const Target> targets, double window,
               const SparseMap& map) {
  const Pose camera_from_world = view.world_from_camera.inverse();
  const ScalePyramid pyramid(*view.features);
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < targets.size(); ++i) {
    auto query = predict(*map.landmark(targets[i].landmark), camera_from_world, *view.frame->camera,
                         pyramid, window);
    if (!query) continue;
    query->id = i;
    query->angle = targets[i].angle;
    queries.push_back(*query);
  }
  const auto usable = [&](std::uint32_t i) { return view.usable(i); };
  assign_targets(
      view, targets,
      match_near(queries, *view.features, view.grid, usable, {.consistent_angles = true}));
  Refined refined{.inliers = solve_pose(view, map), .visible = static_cast<int>(queries.size())};
  view.drop_outliers();
  return refined;
}

// Duplicates: older and newer landmarks of one feature, in all key frames of the newer end.
std::vector<std::pair<LandmarkId, LandmarkId>> same_landmarks(const SparseMap& map,
                                                              const LoopMatch& loop,
                                                              const std::vector<KeyFrameId>& newer,
                                                              std::span<const Target> targets) {
  const Pose correction =
      loop.world_from_camera * map.keyframe(loop.keyframe)->world_from_camera.inverse();
  std::set<std::pair<LandmarkId, LandmarkId>> same;
  for (const KeyFrameId id : newer) {
    const KeyFrame& keyframe = *map.keyframe(id);
    ObservedFrame view = observation_of(keyframe);
    view.world_from_camera = correction * keyframe.world_from_camera;
    refine(view, targets, kNarrowWindow, map);
    for (std::size_t i = 0; i < view.landmarks.size(); ++i)
      if (view.landmarks[i] != kNoId && keyframe.landmarks[i] != kNoId)
        same.emplace(view.landmarks[i], keyframe.landmarks[i]);
  }
  return {same.begin(), same.end()};
}

}  // namespace

std::optional<LoopMatch> match_loop(const SparseMap& map, KeyFrameId keyframe, KeyFrameId place) {
  const std::vector<KeyFrameId> newer = neighbourhood(map, keyframe);
  const std::vector<Target> targets = targets_around(map, place, newer);
  ObservedFrame view = observation_of(*map.keyframe(keyframe));
  const auto guess = camera_from_world(view, targets, map.keyframe(place)->world_from_camera);
  if (!guess) return std::nullopt;
  view.world_from_camera = guess->inverse();
  if (refine(view, targets, kWideWindow, map).inliers < kMinLoopMatches) return std::nullopt;
  const Refined refined = refine(view, targets, kNarrowWindow, map);
  LoopMatch loop{.keyframe = keyframe, .place = place, .inliers = refined.inliers};
  loop.support = static_cast<double>(refined.inliers) /
                 std::max(1, std::min(refined.visible, view.usable_count()));
  if (loop.inliers < kMinInliers || loop.support < kMinSupport) return std::nullopt;
  loop.world_from_camera = view.world_from_camera;
  loop.same = same_landmarks(map, loop, newer, targets);
  return loop;
}

}  // namespace stillpoint::orb_slam
