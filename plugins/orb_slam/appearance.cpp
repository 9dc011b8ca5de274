#include "orb_slam/appearance.hpp"

#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>
#include <optional>

namespace stillpoint::orb {
namespace {

constexpr int kMinMatches = 15;       // to try a pose
constexpr double kRatio = 0.8;        // of the best to the second best descriptor distance
constexpr int kMaxDistance = 70;      // Hamming
constexpr double kRansacPixels = 5;   // reprojection error of an inlier
constexpr int kRansacIterations = 200;
constexpr double kWindow = 10;        // px, of the guided search

// Perspective-n-point with RANSAC; OpenCV seeds it with a constant, so it repeats exactly.
std::optional<Pose> camera_from_world(const ObservedFrame& frame, std::span<const Match> matches,
                                      const SparseMap& map) {
  std::vector<cv::Point3d> points;
  std::vector<cv::Point2d> pixels;
  for (const Match& m : matches) {
    const Eigen::Vector3d& p = map.landmark(m.id)->position_in_world;
    points.emplace_back(p.x(), p.y(), p.z());
    pixels.emplace_back(frame.features->keypoints[m.feature].pt);
  }
  const Camera& c = *frame.frame->camera;
  const cv::Matx33d intrinsics(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1);
  cv::Mat rotation_vector, translation, inliers;
  if (!cv::solvePnPRansac(points, pixels, intrinsics, cv::noArray(), rotation_vector, translation,
                          false, kRansacIterations, kRansacPixels, 0.99, inliers,
                          cv::SOLVEPNP_EPNP) ||
      inliers.rows < kMinMatches)
    return std::nullopt;
  Eigen::Vector3d rotation;
  Pose pose = Pose::Identity();
  cv::cv2eigen(rotation_vector, rotation);
  pose.linear() = exp_so3(rotation);
  pose.translation() << translation.at<double>(0), translation.at<double>(1),
      translation.at<double>(2);
  return pose;
}

Query query_of(const Features& features, std::uint32_t feature, LandmarkId landmark) {
  return {.id = landmark,
          .descriptor = features.descriptors[feature],
          .angle = features.keypoints[feature].angle};
}

std::vector<Query> predictions(std::span<const Query> landmarks, const ObservedFrame& frame,
                               const Pose& camera_from_world, const SparseMap& map) {
  const ScalePyramid pyramid(*frame.features);
  std::vector<Query> queries;
  for (const Query& landmark : landmarks)
    if (auto query = predict(*map.landmark(landmark.id), camera_from_world, *frame.frame->camera,
                             pyramid, kWindow))
      queries.push_back(*query);
  return queries;
}

}  // namespace

std::vector<Query> landmark_queries(const KeyFrame& keyframe, const SparseMap& map) {
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i)
    if (map.landmark(keyframe.landmarks[i]))
      queries.push_back(query_of(*keyframe.features, i, keyframe.landmarks[i]));
  return queries;
}

std::vector<Query> landmark_queries(const ObservedFrame& frame, const SparseMap& map) {
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < frame.landmarks.size(); ++i)
    if (map.landmark(frame.landmarks[i]))
      queries.push_back(query_of(*frame.features, i, frame.landmarks[i]));
  return queries;
}

int locate_by_appearance(ObservedFrame& frame, std::span<const Query> landmarks,
                         const SparseMap& map) {
  const auto usable = [&](std::uint32_t i) { return frame.usable(i); };
  const std::vector<Match> matches = match_anywhere(
      landmarks, *frame.features, usable,
      {.max_distance = kMaxDistance, .ratio = kRatio, .consistent_angles = true});
  if (static_cast<int>(matches.size()) < kMinMatches) return 0;
  const std::optional<Pose> pose = camera_from_world(frame, matches, map);
  if (!pose) return 0;

  frame.world_from_camera = pose->inverse();
  frame.clear_landmarks();
  frame.assign(match_near(predictions(landmarks, frame, *pose, map), *frame.features, frame.grid,
                          usable, {.ratio = 0.9}));
  const int inliers = solve_pose(frame, map);
  frame.drop_outliers();
  return inliers;
}

}  // namespace stillpoint::orb
