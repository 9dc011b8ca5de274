#include "my_plugin.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <stillpoint/support/rigid_motion.hpp>
#include <vector>

namespace plugins::my_plugin {
namespace {

constexpr int kSamples = 200;        // of RANSAC
constexpr double kPixelNoise = 0.5;  // px, of optical flow

struct Followed {
  std::vector<stillpoint::RigidMatch> matches;  // previous to current, metres
  std::vector<cv::Point2f> before, after;       // px, of the same points
};

/// Corners with depth that optical flow finds again.
Followed follow(const stillpoint::Frame& previous, const stillpoint::Frame& current, int corners) {
  std::vector<cv::Point2f> before, after;
  // Spread over the image: otherwise the part with the strongest texture gets all of them.
  const double spacing = 0.8 * std::sqrt(static_cast<double>(previous.gray.total()) / corners);
  cv::goodFeaturesToTrack(previous.gray, before, corners, 0.01, spacing);
  if (before.empty()) return {};
  std::vector<std::uint8_t> found;
  cv::calcOpticalFlowPyrLK(previous.gray, current.gray, before, after, found, cv::noArray());
  Followed result;
  for (std::size_t i = 0; i < before.size(); ++i) {
    const cv::Point2f &a = before[i], &b = after[i];
    if (!found[i] || !current.camera->contains(b.x, b.y)) continue;
    const float depth_a = previous.depth.at<float>(cvRound(a.y), cvRound(a.x));
    const float depth_b = current.depth.at<float>(cvRound(b.y), cvRound(b.x));
    if (!(depth_a > 0) || !(depth_b > 0)) continue;
    result.matches.push_back({.in_source = previous.camera->unproject(a.x, a.y, depth_a),
                              .in_target = current.camera->unproject(b.x, b.y, depth_b),
                              .pixel = {b.x, b.y}});
    result.before.push_back(a);
    result.after.push_back(b);
  }
  return result;
}

}  // namespace

stillpoint::MovingPoints MyPlugin::check(const stillpoint::Frame& previous,
                                         const stillpoint::Frame& current,
                                         const stillpoint::TrackingHistory&) {
  const Followed followed = follow(previous, current, options_.max_corners);
  // The motion that most points agree on is the camera's, as long as most of the image stands
  // still.
  const stillpoint::Camera& camera = *current.camera;
  const auto motion = stillpoint::find_rigid_motion(
      followed.matches, camera, {.pixel = kPixelNoise, .inverse_depth = camera.depth_noise}, {},
      kSamples, seed_);
  stillpoint::MovingPoints result;
  if (!motion) return result;
  int fitting = 0;
  for (std::size_t i = 0; i < followed.matches.size(); ++i) {
    const stillpoint::RigidMatch& match = followed.matches[i];
    const Eigen::Vector3d predicted = motion->target_from_source * match.in_source;
    if (predicted.z() <= 0) continue;
    const double residual = (camera.project(predicted) - match.pixel).norm();
    const bool moving = residual > options_.threshold;
    fitting += moving ? 0 : 1;
    result.points.push_back(
        {followed.before[i], followed.after[i], static_cast<float>(residual), moving});
  }
  result.reliable =
      fitting >= options_.min_inliers && 2 * fitting > static_cast<int>(followed.matches.size());
  if (result.reliable) result.camera_motion = motion->target_from_source;
  return result;
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::MovingChecker, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "optical flow with depth against the camera's own motion"));
