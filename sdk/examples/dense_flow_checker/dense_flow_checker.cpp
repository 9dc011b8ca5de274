#include "dense_flow_checker.hpp"

#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

using stillpoint::Camera;
using stillpoint::Frame;
using stillpoint::MovingPoints;
using stillpoint::PointMotion;
using stillpoint::Pose;
using stillpoint::RigidMatch;
using stillpoint::RigidMotion;

namespace {

constexpr int kSamples = 100;        // of RANSAC
constexpr double kPixelNoise = 0.5;  // px, standard deviation of the flow
constexpr double kSigmas = 3;        // of the camera's motion, by which the threshold grows
constexpr double kDepthJump = 1.1;   // farthest by nearest depth; more is an edge
constexpr double kOccluding = 0.95;  // of a point's depth; what is nearer is in front of it
constexpr int kPatch = 7;            // px, side
constexpr double kGreyNoise = 1.5;   // grey levels, of the difference of two patches

/// 255 within `radius` px of depth edges and of pixels without depth: the flow is not sharp and
/// mixes the motions of both sides.
cv::Mat depth_edges(const cv::Mat& depth, int radius) {
  const cv::Mat window = cv::Mat::ones(2 * radius + 1, 2 * radius + 1, CV_8U);
  cv::Mat nearest, farthest;
  cv::erode(depth, nearest, window);
  cv::dilate(depth, farthest, window);
  return (farthest > kDepthJump * nearest) | (nearest == 0);
}

/// Points of a grid in the previous image, and where the flow takes them; in parallel vectors.
struct Followed {
  std::vector<PointMotion> points;
  std::vector<RigidMatch> matches;  // previous to current
};

Followed follow(const Frame& previous, const Frame& current, const cv::Mat& flow, int spacing,
                int edge) {
  const cv::Mat edges = depth_edges(previous.depth, edge);
  const cv::Mat edges_now = depth_edges(current.depth, edge);
  Followed followed;
  for (int v = spacing / 2; v < flow.rows; v += spacing)
    for (int u = spacing / 2; u < flow.cols; u += spacing) {
      const cv::Point before(u, v);
      const cv::Point2f now = cv::Point2f(before) + cv::Point2f(flow.at<cv::Vec2f>(before));
      if (!current.camera->contains(now.x, now.y)) continue;
      const cv::Point pixel(now);
      if (edges.at<std::uint8_t>(before) != 0 || edges_now.at<std::uint8_t>(pixel) != 0) continue;
      const float depth = previous.depth.at<float>(before);
      const float depth_now = current.depth.at<float>(pixel);
      followed.points.push_back({.previous = before, .current = now});
      followed.matches.push_back({.in_source = previous.camera->unproject(u, v, depth),
                                  .in_target = current.camera->unproject(now.x, now.y, depth_now),
                                  .pixel = {now.x, now.y}});
    }
  return followed;
}

/// Mean difference of the grey levels around two pixels.
double difference(const cv::Mat& before, const cv::Point2f& pixel_before, const cv::Mat& now,
                  const cv::Point2f& pixel_now) {
  cv::Mat patch_before, patch_now;
  cv::getRectSubPix(before, {kPatch, kPatch}, pixel_before, patch_before);
  cv::getRectSubPix(now, {kPatch, kPatch}, pixel_now, patch_now);
  return cv::norm(patch_before, patch_now, cv::NORM_L1) / (kPatch * kPatch);
}

bool is_occluded(const Eigen::Vector3d& point, const cv::Point2f& pixel, const Frame& frame) {
  if (!frame.camera->contains(pixel.x, pixel.y)) return false;
  const float seen = frame.depth.at<float>(cv::Point(pixel));
  return seen > 0 && seen < kOccluding * point.z();
}

}  // namespace

void DenseFlowChecker::Options::visit(stillpoint::OptionVisitor& v) {
  v("threshold", threshold,
    {.min = 0.1, .unit = "px", .help = "more flow than this beside the camera's is moving"});
  v("spacing", spacing, {.min = 1, .max = 200, .unit = "px", .help = "of the grid of points"});
  v("edge", edge,
    {.min = 0, .max = 50, .unit = "px", .help = "around depth edges, where no point is judged"});
  v("min_agreement", min_agreement,
    {.min = 0,
     .max = 1,
     .help = "share of the points with one motion; with less, nothing is known"});
  v.choice("quality", quality, {{"ultrafast", kUltraFast}, {"fast", kFast}, {"medium", kMedium}},
           {.help = "of the flow; medium takes twice as long as fast"});
}

MovingPoints DenseFlowChecker::check(const Frame& previous, const Frame& current,
                                     const stillpoint::TrackingHistory& history) {
  const std::vector<Pose> guesses = likely_motions(history);
  cv::Mat flow;  // CV_32FC2, px, from previous to current
  flow_->calc(previous.gray, current.gray, flow);
  Followed followed = follow(previous, current, flow, options_.spacing, options_.edge);
  const Camera& camera = *current.camera;
  const auto motion = stillpoint::find_rigid_motion(
      followed.matches, camera, {.pixel = kPixelNoise, .inverse_depth = camera.depth_noise},
      guesses, kSamples, seed_);
  MovingPoints result;
  if (!motion || motion->agreement < options_.min_agreement) return result;
  for (std::size_t i = 0; i < followed.points.size(); ++i)
    if (judge(followed.points[i], followed.matches[i], *motion, previous, current))
      result.points.push_back(followed.points[i]);
  result.reliable = true;
  result.camera_motion = motion->target_from_source;
  return result;
}

/// What current_from_previous may be: none, or as between the two frames before, whose poses
/// tracking knows better than two images tell when somebody fills the picture.
std::vector<Pose> DenseFlowChecker::likely_motions(const stillpoint::TrackingHistory& history) {
  std::vector<Pose> motions = {Pose::Identity()};
  const std::optional<Pose>& world_from_previous = history.world_from_previous;
  if (world_from_previous && world_from_earlier_)
    motions.push_back(world_from_previous->inverse() * *world_from_earlier_);
  world_from_earlier_ = world_from_previous;
  return motions;
}

/// False: nothing is known of the point.
bool DenseFlowChecker::judge(PointMotion& point, const RigidMatch& match, const RigidMotion& motion,
                             const Frame& previous, const Frame& current) const {
  const Eigen::Vector3d still = motion.target_from_source * match.in_source;
  if (still.z() <= 0) return false;
  const Eigen::Vector2d predicted = current.camera->project(still);
  const cv::Point2f pixel(static_cast<float>(predicted.x()), static_cast<float>(predicted.y()));
  if (is_occluded(still, pixel, current)) return false;
  const double uncertainty = stillpoint::pixel_uncertainty(motion, *current.camera, still);
  point.residual = static_cast<float>((match.pixel - predicted).norm());
  // Where there is little texture, the flow is that of the surroundings: no evidence, unless
  // the image fits it better than it fits a point that stands still.
  point.moving =
      point.residual > std::hypot(options_.threshold, kSigmas * uncertainty) &&
      difference(previous.gray, point.previous, current.gray, point.current) + kGreyNoise <
          difference(previous.gray, point.previous, current.gray, pixel);
  return true;
}

STILLPOINT_PLUGIN(dense_flow_checker, "0.1.0",
                  stillpoint::provide<stillpoint::MovingChecker, DenseFlowChecker>(
                      "dense_flow",
                      "dense optical flow that the camera's motion does not explain"));
