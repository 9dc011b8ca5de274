#include "stillpoint/testing/test_recording.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <iostream>
#include <limits>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>
#include <random>
#include <utility>

#include "stillpoint/support/objects.hpp"

namespace stillpoint::testing {
namespace {

constexpr double kPersonSpeed = 1.0;                      // m/s
constexpr double kPersonDistance = 2.0;                   // metres from the first camera
constexpr double kBodyRadius = 0.35, kHeadRadius = 0.15;  // metres
constexpr std::uint8_t kPerson = 1;
constexpr int kGrid = 16;  // px

struct Box {
  Eigen::Vector3d low, high;  // metres; x right, y down, z forward
};
// The room, seen from inside, and its furniture.
const Box kRoom = {{-3, -1.5, -2}, {3, 1.5, 4}};
const std::array<Box, 4> kFurniture = {
    Box{{-2.2, 0.2, 2.6}, {-1.0, 1.5, 3.4}}, Box{{1.1, -0.4, 2.9}, {1.7, 1.5, 3.6}},
    Box{{-0.4, 0.7, 2.4}, {0.7, 1.5, 3.0}}, Box{{-0.9, -1.0, 3.7}, {0.5, -0.3, 4.0}}};

struct Hit {
  double depth = std::numeric_limits<double>::infinity();  // along z of the camera
  Eigen::Vector3d texture = Eigen::Vector3d::Zero();       // metres, fixed to the surface
  int surface = 0;                                         // seed of its texture
  bool person = false;
};

double hashed(std::int64_t x, std::int64_t y, std::int64_t z, std::uint64_t seed) {
  std::uint64_t h = static_cast<std::uint64_t>(x) * 0x9E3779B97F4A7C15ULL ^
                    static_cast<std::uint64_t>(y) * 0xC2B2AE3D27D4EB4FULL ^
                    static_cast<std::uint64_t>(z) * 0x165667B19E3779F9ULL ^ (seed << 32);
  h = (h ^ (h >> 30)) * 0xBF58476D1CE4E5B9ULL;
  h = (h ^ (h >> 27)) * 0x94D049BB133111EBULL;
  return static_cast<double>(h >> 40) / static_cast<double>(1 << 24);
}

/// Value noise in [0, 1], smooth between the points of a grid of 1.
double noise(const Eigen::Vector3d& at, std::uint64_t seed) {
  const Eigen::Vector3d cell = at.array().floor();
  const Eigen::Array3d t = at - cell;
  const Eigen::Array3d s = t * t * (3 - 2 * t);
  const Eigen::Matrix<std::int64_t, 3, 1> first = cell.cast<std::int64_t>();
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1;
    Eigen::Matrix<std::int64_t, 3, 1> point = first;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = corner >> axis & 1;
      weight *= upper ? s[axis] : 1 - s[axis];
      point[axis] += upper;
    }
    sum += weight * hashed(point.x(), point.y(), point.z(), seed);
  }
  return sum;
}

/// Where a ray enters (or, from inside, leaves) a box: `ray` is one metre deep.
void meet_box(const Box& box, bool from_inside, const Eigen::Vector3d& eye,
              const Eigen::Vector3d& ray, int surface, Hit& hit) {
  const Eigen::Array3d a = (box.low - eye).array() / ray.array();
  const Eigen::Array3d b = (box.high - eye).array() / ray.array();
  const double enters = a.min(b).maxCoeff();
  const double leaves = a.max(b).minCoeff();
  const double depth = from_inside ? leaves : enters;
  if (enters > leaves || depth <= 0 || depth >= hit.depth) return;
  hit = {depth, eye + depth * ray, surface, false};
}

void meet_sphere(const Eigen::Vector3d& centre, double radius, const Eigen::Vector3d& eye,
                 const Eigen::Vector3d& ray, int surface, Hit& hit) {
  const Eigen::Vector3d to_centre = centre - eye;
  const double along = to_centre.dot(ray) / ray.squaredNorm();
  const double past = radius * radius - (to_centre - along * ray).squaredNorm();
  if (past < 0) return;
  const double depth = along - std::sqrt(past / ray.squaredNorm());
  if (depth <= 0 || depth >= hit.depth) return;
  hit = {depth, eye + depth * ray - centre, surface, true};
}

Hit trace(const Eigen::Vector3d& eye, const Eigen::Vector3d& ray, const Eigen::Vector3d* person) {
  Hit hit;
  meet_box(kRoom, true, eye, ray, 1, hit);
  for (std::size_t i = 0; i < kFurniture.size(); ++i)
    meet_box(kFurniture[i], false, eye, ray, static_cast<int>(2 + i), hit);
  if (person != nullptr) {
    meet_sphere(*person, kBodyRadius, eye, ray, 10, hit);
    meet_sphere(*person - Eigen::Vector3d(0, kBodyRadius + kHeadRadius, 0), kHeadRadius, eye, ray,
                11, hit);
  }
  return hit;
}

/// Detail that shrinks with the distance would be lost between pixels: two fixed sizes.
cv::Vec3b colour_of(const Hit& hit, std::uint64_t seed) {
  const std::uint64_t of_surface = seed * 64 + static_cast<std::uint64_t>(hit.surface);
  const double fine = noise(hit.texture / 0.05, of_surface);
  const double coarse = noise(hit.texture / 0.16, of_surface + 32);
  const double light = 0.15 + 0.8 * (0.5 * fine + 0.5 * coarse);
  cv::Vec3b colour;
  for (int channel = 0; channel < 3; ++channel) {
    const double tint = 0.7 + 0.3 * hashed(hit.surface, channel, 0, seed);
    colour[channel] = cv::saturate_cast<std::uint8_t>(255 * light * tint);
  }
  return colour;
}

Pose camera_pose(double seconds, double speed) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3({0.02 * speed * std::sin(4 * seconds), 0.3 * speed * seconds, 0});
  pose.translation() =
      Eigen::Vector3d(speed * seconds, 0.1 * speed * std::sin(3 * seconds), 0.2 * speed * seconds);
  return pose;
}

Eigen::Vector3d person_at(double seconds) {
  return {-0.8 + kPersonSpeed * seconds, 0.2, kPersonDistance};
}

std::vector<std::uint8_t> at_features(const cv::Mat& weights, const Features& features) {
  std::vector<std::uint8_t> values;
  for (const cv::KeyPoint& keypoint : features.keypoints)
    values.push_back(StaticWeights::at(weights, keypoint.pt.x, keypoint.pt.y));
  return values;
}

FeaturesPtr orb_features(const Frame& frame) {
  auto features = std::make_shared<Features>();
  const auto orb =
      cv::ORB::create(500, static_cast<float>(features->scale_factor), features->levels);
  cv::Mat descriptors;
  orb->detectAndCompute(frame.gray, cv::noArray(), features->keypoints, descriptors);
  for (int i = 0; i < descriptors.rows; ++i) {
    std::memcpy(features->descriptors.emplace_back().data(), descriptors.ptr(i),
                sizeof(Descriptor));
    const cv::Point2f& at = features->keypoints[static_cast<std::size_t>(i)].pt;
    features->depth.push_back(frame.depth.at<float>(cvRound(at.y), cvRound(at.x)));
  }
  return features;
}

/// Knows its noise; without any, it has that of a usual sensor.
std::shared_ptr<const Camera> camera_of(const TestRecordingOptions& options) {
  Camera camera{.width = options.width,
                .height = options.height,
                .fx = 0.82 * options.width,
                .fy = 0.82 * options.width,
                .cx = (options.width - 1) / 2.0,
                .cy = (options.height - 1) / 2.0};
  if (options.depth_noise > 0) camera.surface_noise = options.depth_noise;
  camera.depth_noise = std::max(camera.depth_noise, options.depth_noise);
  return std::make_shared<const Camera>(camera);
}

}  // namespace

TestRecording::TestRecording(const TestRecordingOptions& options) : camera_(camera_of(options)) {
  for (int i = 0; i < options.frames; ++i) views_.push_back(view_at(i, options));
}

TestRecording::View TestRecording::view_at(int i, const TestRecordingOptions& options) const {
  const double seconds = i / options.frames_per_second;
  View view{.world_from_camera = camera_pose(seconds, options.metres_per_second),
            .person = person_at(seconds)};
  auto frame =
      std::make_shared<Frame>(Frame{.index = options.first_index + static_cast<std::uint32_t>(i),
                                    .time = seconds,
                                    .bgr = cv::Mat(options.height, options.width, CV_8UC3),
                                    .depth = cv::Mat(options.height, options.width, CV_32FC1),
                                    .camera = camera_});
  auto segmentation = std::make_shared<Segmentation>();
  segmentation->frame = frame->index;
  segmentation->labels = cv::Mat(options.height, options.width, CV_8UC1);
  std::mt19937_64 random(options.seed * 1000003 + static_cast<std::uint64_t>(i));
  std::normal_distribution<double> normal;
  for (int v = 0; v < options.height; ++v)
    for (int u = 0; u < options.width; ++u) {
      const Eigen::Vector3d ray = view.world_from_camera.linear() * camera_->unproject(u, v, 1.0);
      const Hit hit =
          trace(view.world_from_camera.translation(), ray, options.person ? &view.person : nullptr);
      frame->bgr.at<cv::Vec3b>(v, u) = colour_of(hit, options.seed);
      const double error = options.depth_noise * hit.depth * hit.depth * normal(random);
      frame->depth.at<float>(v, u) = static_cast<float>(hit.depth + error);
      segmentation->labels.at<std::uint8_t>(v, u) = hit.person ? kPerson : 0;
    }
  cv::cvtColor(frame->bgr, frame->gray, cv::COLOR_BGR2GRAY);
  find_objects(*segmentation, 1);
  auto weights = std::make_shared<StaticWeights>();
  weights->track = segmentation->labels != kPerson;
  weights->map = weights->track;
  weights->object_moves.assign(segmentation->objects.size(), true);
  view.frame = std::move(frame);
  view.segmentation = std::move(segmentation);
  view.weights = std::move(weights);
  return view;
}

MovingPoints TestRecording::moving_points(std::size_t i) const {
  if (i == 0) return {};
  const View& previous = views_.at(i - 1);
  const View& current = views_.at(i);
  const Pose current_from_world = current.world_from_camera.inverse();
  MovingPoints result{.reliable = true,
                      .camera_motion = current_from_world * previous.world_from_camera};
  for (int v = kGrid / 2; v < camera_->height; v += kGrid)
    for (int u = kGrid / 2; u < camera_->width; u += kGrid) {
      const bool moving = previous.segmentation->labels.at<std::uint8_t>(v, u) == kPerson;
      const Eigen::Vector3d before =
          previous.world_from_camera *
          camera_->unproject(u, v, previous.frame->depth.at<float>(v, u));
      const Eigen::Vector3d still = current_from_world * before;
      const Eigen::Vector3d now =
          moving ? current_from_world * (before + current.person - previous.person) : still;
      if (now.z() <= 0 || still.z() <= 0) continue;
      const Eigen::Vector2d at = camera_->project(now);
      if (!camera_->contains(at.x(), at.y())) continue;
      const auto seen = current.frame->depth.at<float>(static_cast<int>(std::lround(at.y())),
                                                       static_cast<int>(std::lround(at.x())));
      if (std::abs(seen - now.z()) > 0.05 * now.z()) continue;  // occluded
      result.points.push_back(
          {.previous = cv::Point2f(static_cast<float>(u), static_cast<float>(v)),
           .current = cv::Point2f(static_cast<float>(at.x()), static_cast<float>(at.y())),
           .residual = static_cast<float>((at - camera_->project(still)).norm()),
           .moving = moving});
    }
  return result;
}

KeyFrame TestRecording::keyframe(std::size_t i, KeyFrameId id) const {
  const View& view = views_.at(i);
  return orb_keyframe(*view.frame, *view.weights, view.world_from_camera, id);
}

DenseKeyFrame TestRecording::dense_keyframe(std::size_t i, KeyFrameId id) const {
  const View& view = views_.at(i);
  return {.id = id,
          .frame = view.frame,
          .segmentation = view.segmentation,
          .weights = view.weights,
          .world_from_camera = view.world_from_camera};
}

KeyFrame orb_keyframe(const Frame& frame, const StaticWeights& weights,
                      const Pose& world_from_camera, KeyFrameId id) {
  KeyFrame keyframe{.id = id,
                    .frame = frame.index,
                    .time = frame.time,
                    .world_from_camera = world_from_camera,
                    .camera = frame.camera,
                    .features = orb_features(frame)};
  keyframe.track_weights = at_features(weights.track, *keyframe.features);
  keyframe.map_weights = at_features(weights.map, *keyframe.features);
  keyframe.landmarks.assign(keyframe.features->size(), kNoId);
  return keyframe;
}

StageContext test_context() {
  StageContext context;
  context.classes = TestRecording::classes();
  context.log = [](LogLevel level, std::string_view message) {
    if (level >= LogLevel::kWarning) std::cerr << message << '\n';
  };
  return context;
}

}  // namespace stillpoint::testing
