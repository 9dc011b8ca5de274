#include "orb_slam/landmark_geometry.hpp"

#include <algorithm>
#include <limits>

#include "orb_slam/pose_solver.hpp"
#include "orb_slam/scale_pyramid.hpp"

namespace stillpoint::orb_slam {
namespace {

// More would cost quadratic time and change the choice little.
constexpr std::size_t kMaxDescriptors = 16;

// The descriptor with the smallest median distance to all others.
Descriptor typical_descriptor(const SparseMap& map, const Landmark& landmark) {
  std::vector<Descriptor> all;
  const std::size_t step = 1 + (landmark.observations.size() - 1) / kMaxDescriptors;
  for (std::size_t i = 0; i < landmark.observations.size(); i += step) {
    const Observation& o = landmark.observations[i];
    all.push_back(map.keyframe(o.keyframe)->features->descriptors[o.feature]);
  }
  std::size_t best = 0;
  int best_median = std::numeric_limits<int>::max();
  std::vector<int> distances(all.size());
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < all.size(); ++j) distances[j] = hamming_distance(all[i], all[j]);
    const auto middle = distances.begin() + static_cast<std::ptrdiff_t>((all.size() - 1) / 2);
    std::nth_element(distances.begin(), middle, distances.end());
    if (*middle >= best_median) continue;
    best_median = *middle;
    best = i;
  }
  return all[best];
}

}  // namespace

void refresh_landmark(MapEdit& edit, LandmarkId id) {
  const SparseMap& map = edit.map();
  if (!map.landmark(id)) return;
  Landmark& landmark = edit.landmark(id);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const Observation& o : landmark.observations) {
    const Pose& world_from_camera = map.keyframe(o.keyframe)->world_from_camera;
    const Eigen::Vector3d view = landmark.position_in_world - world_from_camera.translation();
    sum += view.normalized();
    if (o.keyframe != landmark.reference) continue;
    const Features& features = *map.keyframe(o.keyframe)->features;
    ScalePyramid(features).set_distance_range(landmark, features.keypoints[o.feature].octave,
                                              view.norm());
  }
  landmark.mean_view = sum.normalized();
  landmark.descriptor = typical_descriptor(map, landmark);
}

ObservationError observation_error(const Eigen::Vector3d& point_in_world,
                                   const Pose& camera_from_world, const KeyFrame& keyframe,
                                   std::uint32_t feature) {
  const Eigen::Vector3d p = camera_from_world * point_in_world;
  if (p.z() <= 0) return {std::numeric_limits<double>::infinity(), kChiSquare2};
  const cv::KeyPoint& k = keyframe.features->keypoints[feature];
  const double sigma = ScalePyramid(*keyframe.features).pixel_sigma(k.octave);
  const Eigen::Vector2d pixel = keyframe.camera->project(p);
  ObservationError error{(pixel - Eigen::Vector2d(k.pt.x, k.pt.y)).squaredNorm() / (sigma * sigma),
                         kChiSquare2};
  const double depth = keyframe.features->depth[feature];
  if (depth > 0) {
    const double r = (1.0 / p.z() - 1.0 / depth) / keyframe.camera->depth_noise;
    error.squared += r * r;
    error.bound = kChiSquare3;
  }
  return error;
}

bool observation_fits(const SparseMap& map, const Eigen::Vector3d& point_in_world,
                      const Observation& observation) {
  const KeyFrame& keyframe = *map.keyframe(observation.keyframe);
  return observation_error(point_in_world, keyframe.world_from_camera.inverse(), keyframe,
                           observation.feature)
      .fits();
}

void remove_outlier_observations(MapEdit& edit, LandmarkId id) {
  const std::vector<Observation> observations = edit.map().landmark(id)->observations;
  for (const Observation& o : observations) {
    const Landmark* landmark = edit.map().landmark(id);
    if (!landmark) return;
    if (!observation_fits(edit.map(), landmark->position_in_world, o))
      edit.remove_observation(id, o.keyframe);
  }
}

}  // namespace stillpoint::orb_slam
