#include "orb_slam/bundle_adjustment.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "orb_slam/bundle_solver.hpp"
#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/scale_pyramid.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr std::size_t kMinLandmarks = 20;  // observed; the pose of a key frame with fewer is fixed

bool observes_few_landmarks(const KeyFrame& keyframe) {
  return keyframe.landmarks.size() -
             static_cast<std::size_t>(std::ranges::count(keyframe.landmarks, kNoId)) <
         kMinLandmarks;
}

// Key frames to optimise, landmarks, and further key frames that observe them and stay fixed.
class BundleProblem {
 public:
  BundleProblem(const SparseMap& map, std::vector<KeyFrameId> moving,
                std::vector<LandmarkId> landmarks)
      : map_(map), landmarks_(std::move(landmarks)), camera_of_(map.keyframe_id_end(), kUnknown) {
    // Fixed: the origin, and key frames whose pose depth rather than landmarks constrains.
    std::erase_if(moving, [&](KeyFrameId id) {
      return id == map.keyframe_id_begin() || observes_few_landmarks(*map.keyframe(id));
    });
    for (const KeyFrameId id : moving) camera_of_[id] = add_camera(id, true);
    moving_ = std::move(moving);
    for (const LandmarkId id : landmarks_) add_landmark(id);
  }

  bool solve(int max_iterations, const std::stop_token& end_early) {
    return solver_.solve(max_iterations, end_early);
  }

  std::vector<MovedKeyFrame> keyframes() const {
    std::vector<MovedKeyFrame> moved;
    for (const KeyFrameId id : moving_)
      moved.push_back({id, orthonormalised(solver_.camera_from_world(camera_of_[id]).inverse())});
    return moved;
  }
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> landmarks() const {
    std::vector<std::pair<LandmarkId, Eigen::Vector3d>> positions;
    for (std::size_t i = 0; i < landmarks_.size(); ++i)
      positions.emplace_back(landmarks_[i], solver_.point(i));
    return positions;
  }

 private:
  static constexpr int kUnknown = -1;

  int add_camera(KeyFrameId id, bool moves) {
    return solver_.add_camera(map_.keyframe(id)->world_from_camera.inverse(), moves);
  }

  void add_landmark(LandmarkId id) {
    const Landmark& landmark = *map_.landmark(id);
    solver_.add_point(landmark.position_in_world);
    for (const Observation& o : landmark.observations) {
      int& camera = camera_of_[o.keyframe];
      if (camera == kUnknown) camera = add_camera(o.keyframe, false);
      solver_.observe(camera, measurement(*map_.keyframe(o.keyframe), o.feature));
    }
  }

  static BundleMeasurement measurement(const KeyFrame& keyframe, std::uint32_t feature) {
    const Features& features = *keyframe.features;
    const cv::KeyPoint& k = features.keypoints[feature];
    const double trust = std::sqrt(keyframe.track_weights[feature] / 255.0);
    const double sigma = ScalePyramid(features).pixel_sigma(k.octave);
    const double depth = features.depth[feature];
    const Camera& c = *keyframe.camera;
    return {.fx = c.fx,
            .fy = c.fy,
            .cx = c.cx,
            .cy = c.cy,
            .u = k.pt.x,
            .v = k.pt.y,
            .inverse_depth = depth > 0 ? 1.0 / depth : 0.0,
            .pixel_weight = trust / sigma,
            .depth_weight = depth > 0 ? trust / c.depth_noise : 0.0};
  }

  const SparseMap& map_;
  std::vector<KeyFrameId> moving_;
  std::vector<LandmarkId> landmarks_;
  std::vector<int> camera_of_;  // by key frame id
  BundleSolver solver_;
};

std::vector<KeyFrameId> most_covisible(const SparseMap& map, KeyFrameId centre, int count) {
  std::vector<KeyFrameId> ids{centre};
  for (const Covisibility& c : map.keyframe(centre)->covisible)
    if (static_cast<int>(ids.size()) < count) ids.push_back(c.keyframe);
  return ids;
}

std::vector<LandmarkId> observed_by(const SparseMap& map,
                                    const std::vector<KeyFrameId>& keyframes) {
  std::set<LandmarkId> ids;
  for (const KeyFrameId keyframe : keyframes)
    for (const LandmarkId id : map.keyframe(keyframe)->landmarks)
      if (id != kNoId) ids.insert(id);
  return {ids.begin(), ids.end()};
}

}  // namespace

std::vector<LandmarkId> adjust_locally(MapEdit& edit, KeyFrameId centre,
                                       const BundleOptions& options,
                                       const std::stop_token& end_early) {
  const std::vector<KeyFrameId> local = most_covisible(edit.map(), centre, options.max_keyframes);
  std::vector<LandmarkId> points = observed_by(edit.map(), local);
  BundleProblem problem(edit.map(), local, points);
  if (!problem.solve(options.max_iterations, end_early)) return {};
  for (const MovedKeyFrame& moved : problem.keyframes())
    edit.keyframe(moved.keyframe).world_from_camera = moved.world_from_camera;
  for (const auto& [id, position] : problem.landmarks())
    edit.landmark(id).position_in_world = position;
  for (const LandmarkId id : points) remove_outlier_observations(edit, id);
  return points;
}

std::optional<MapCorrection> adjust_all(const SparseMap& map, int max_iterations,
                                        const std::stop_token& end_early) {
  std::vector<KeyFrameId> keyframes;
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    if (map.keyframe(id)) keyframes.push_back(id);
  BundleProblem problem(map, keyframes, observed_by(map, keyframes));
  if (!problem.solve(max_iterations, end_early)) return std::nullopt;
  return MapCorrection{.keyframe_id_end = static_cast<KeyFrameId>(map.keyframe_id_end()),
                       .moved = problem.keyframes(),
                       .landmarks = problem.landmarks()};
}

}  // namespace stillpoint::orb_slam
