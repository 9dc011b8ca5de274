#include "stillpoint/runtime/map_values.hpp"

#include <algorithm>
#include <cmath>

#include "stillpoint/runtime/map_reader.hpp"

namespace stillpoint {
namespace {

constexpr int kMaxImageSide = 16384;   // px
constexpr double kLongestFocal = 1e6;  // px
constexpr double kFarthest = 1e7;      // m
constexpr double kLeastNoise = 1e-6;   // m, as in CameraModel
constexpr double kMostNoise = 100;     // m
constexpr double kMostScale = 4;       // between two levels
constexpr int kMostLevels = 64;
constexpr double kImageMargin = 1;  // px, of corners refined to fractions of a pixel

bool within(double value, double low, double high) { return value >= low && value <= high; }

void require(bool possible, const char* what) {
  if (!possible) throw DamagedMap(std::string(what) + " has impossible values");
}

bool is_inside(const cv::Point2f& position, const Camera& camera) {
  return within(position.x, -kImageMargin, camera.width + kImageMargin) &&
         within(position.y, -kImageMargin, camera.height + kImageMargin);
}

bool is_possible(const cv::KeyPoint& keypoint) {
  return within(keypoint.size, 0, kMaxImageSide) && std::isfinite(keypoint.angle) &&
         std::isfinite(keypoint.response);
}

}  // namespace

bool possible(const Camera& camera) {
  return within(camera.width, 1, kMaxImageSide) && within(camera.height, 1, kMaxImageSide) &&
         within(camera.fx, 1, kLongestFocal) && within(camera.fy, 1, kLongestFocal) &&
         within(camera.cx, -kLongestFocal, kLongestFocal) &&
         within(camera.cy, -kLongestFocal, kLongestFocal) &&
         within(camera.depth_noise, kLeastNoise, kMostNoise) &&
         within(camera.surface_noise, kLeastNoise, kMostNoise);
}

bool is_rigid_motion(const Pose& pose) {
  const Eigen::Matrix3d rotation = pose.linear();
  return pose.matrix().allFinite() && is_near(pose.translation()) &&
         rotation.determinant() > 0 &&  // no mirror image
         (rotation * rotation.transpose() - Eigen::Matrix3d::Identity()).norm() < kLargestSkew &&
         pose.matrix().row(3) == Eigen::RowVector4d(0, 0, 0, 1);
}

bool is_near(const Eigen::Vector3d& position) { return position.norm() <= kFarthest; }

std::string fault_of(const Landmark& landmark) {
  if (!is_near(landmark.position_in_world))
    return "its position is not finite, or beyond 10,000 km";
  if (!(landmark.mean_view.norm() <= 1.001)) return "its mean view is no unit vector";
  if (!within(landmark.min_distance, 0, kFarthest) ||
      !within(landmark.max_distance, landmark.min_distance, kFarthest))
    return "its distances are negative, not in order or beyond 10,000 km";
  if (!std::isfinite(landmark.static_log_odds)) return "its log-odds are not finite";
  return "";
}

std::string fault_of(const Features& features, const Camera& camera) {
  if (!within(features.levels, 1, kMostLevels) || !within(features.scale_factor, 1, kMostScale))
    return "it has no pyramid of 1 to 64 levels, with a factor of 1 to 4";
  for (const cv::KeyPoint& keypoint : features.keypoints) {
    if (!is_inside(keypoint.pt, camera)) return "a keypoint is not in the image";
    if (keypoint.octave < 0 || keypoint.octave >= features.levels)
      return "a keypoint has octave " + std::to_string(keypoint.octave) + " of " +
             std::to_string(features.levels);
    if (!is_possible(keypoint)) return "the size, angle or response of a keypoint cannot be";
  }
  const auto is_depth = [](float z) { return within(z, 0, kFarthest); };
  if (!std::ranges::all_of(features.depth, is_depth))
    return "the depth of a feature is negative or no number";
  return "";
}

void check_values(const Camera& camera) { require(possible(camera), "a camera"); }

void check_values(const Landmark& landmark) { require(fault_of(landmark).empty(), "a landmark"); }

void check_values(const KeyFrame& keyframe) {
  require(std::isfinite(keyframe.time) && is_rigid_motion(keyframe.world_from_camera) &&
              fault_of(*keyframe.features, *keyframe.camera).empty(),
          "a key frame");
}

}  // namespace stillpoint
