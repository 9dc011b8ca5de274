#include "orb_slam/relocaliser.hpp"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/core/eigen.hpp>

namespace stillpoint::orb {
namespace {

constexpr int kNearby = 2;           // candidates per frame around the last known place
constexpr int kAround = 2;           // candidates per frame on the way round the map
constexpr int kMinMatches = 15;      // to try a pose
constexpr int kMinInliers = 30;      // after the guided search
constexpr double kRansacPixels = 5;  // reprojection error of an inlier
constexpr int kRansacIterations = 200;
constexpr double kWindow = 10;       // px, of the guided search

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

bool try_keyframe(ObservedFrame& frame, const KeyFrame& keyframe, const SparseMap& map) {
  const auto usable = [&](std::uint32_t i) { return frame.usable(i); };
  const std::vector<Match> matches =
      match_anywhere(landmark_queries(keyframe, map), *frame.features, usable,
                     {.max_distance = kNear + 20, .ratio = 0.8, .consistent_angles = true});
  if (static_cast<int>(matches.size()) < kMinMatches) return false;
  const std::optional<Pose> pose = camera_from_world(frame, matches, map);
  if (!pose) return false;

  frame.world_from_camera = pose->inverse();
  frame.clear_landmarks();
  const ScalePyramid pyramid(*frame.features);
  std::vector<Query> queries;
  for (const LandmarkId id : keyframe.landmarks)
    if (const Landmark* landmark = map.landmark(id))
      if (auto query = predict(*landmark, *pose, *frame.frame->camera, pyramid, kWindow))
        queries.push_back(*query);
  frame.assign(match_near(queries, *frame.features, frame.grid, usable, {.ratio = 0.9}));
  if (solve_pose(frame, map) < kMinInliers) return false;
  frame.drop_outliers();
  frame.reference = keyframe.id;
  return true;
}

}  // namespace

std::vector<Query> landmark_queries(const KeyFrame& keyframe, const SparseMap& map) {
  std::vector<Query> queries;
  for (std::uint32_t i = 0; i < keyframe.landmarks.size(); ++i) {
    if (!map.landmark(keyframe.landmarks[i])) continue;
    queries.push_back({.id = keyframe.landmarks[i],
                       .descriptor = keyframe.features->descriptors[i],
                       .angle = keyframe.features->keypoints[i].angle});
  }
  return queries;
}

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
  for (const KeyFrameId id : candidates(map))
    if (try_keyframe(frame, *map.keyframe(id), map)) return true;
  frame.clear_landmarks();
  return false;
}

}  // namespace stillpoint::orb
