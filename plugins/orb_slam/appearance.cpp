#include "orb_slam/appearance.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <optional>

namespace stillpoint::orb_slam {
namespace {

constexpr int kMinAppearanceMatches = 15;  // to attempt a pose
constexpr double kRatio = 0.8;             // of the best to the second best descriptor distance
constexpr int kMaxDistance = 70;           // Hamming
constexpr double kRansacPixels = 5;        // reprojection error of an inlier
constexpr int kRansacIterations = 200;
constexpr double kGuidedWindow = 10;  // px, of the guided search
constexpr int kLevels = 2;            // of the pyramid, up and down, of the guided search

// Perspective-n-point with RANSAC; OpenCV seeds it with a constant, so it repeats exactly.
std::optional<Pose> camera_from_world(const ObservedFrame& frame, std::span<const Target> targets,
                                      std::span<const Match> matches) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const Match& m : matches) {
    const Eigen::Vector3d& p = targets[m.id].point_in_world;
    points.emplace_back(p.x(), p.y(), p.z());
    pixels.emplace_back(frame.features->keypoints[m.feature].pt);
  }
  const Camera& c = *frame.frame->camera;
  const cv::Matx33d intrinsics(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  cv::Mat rotation_vector, translation, inliers;
  if (!cv::solvePnPRansac(points, pixels, intrinsics, cv::noArray(), rotation_vector, translation,
                          false, kRansacIterations, kRansacPixels, 0.99, inliers,
                          cv::SOLVEPNP_EPNP) ||
      inliers.rows < kMinAppearanceMatches)
    return std::nullopt;
  Eigen::Vector3d rotation;
  Pose pose = Pose::Identity();
  cv::cv2eigen(rotation_vector, rotation);
  pose.linear() = exp_so3(rotation);
  pose.translation() << translation.at<double>(0), translation.at<double>(1),
      translation.at<double>(2);
  return pose;
}

std::vector<Query> anywhere(std::span<const Target> targets) {
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < targets.size(); ++i)
    queries.push_back({.id = i, .descriptor = targets[i].descriptor, .angle = targets[i].angle});
  return queries;
}

}  // namespace

int locate_by_appearance(ObservedFrame& frame, std::span<const Target> targets,
                         const SparseMap& map) {
  const std::vector<Match> matches = match_anywhere(
      anywhere(targets), *frame.features, [&](std::uint32_t i) { return frame.usable(i); },
      {.max_distance = kMaxDistance, .ratio = kRatio, .consistent_angles = true});
  if (static_cast<int>(matches.size()) < kMinAppearanceMatches) return 0;
  const std::optional<Pose> pose = camera_from_world(frame, targets, matches);
  if (!pose) return 0;

  frame.world_from_camera = pose->inverse();
  match_projected(frame, targets, *pose, kGuidedWindow, kLevels);
  const int inliers = solve_pose(frame, map);
  frame.drop_outliers();
  return inliers;
}

}  // namespace stillpoint::orb_slam
