#include "moving_checks/rgbd_checker.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "stillpoint/support/median.hpp"
#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::moving_checks {

namespace {

// Times Camera::surface_noise: tracked to half a pixel only, a point on an inclined surface has an
// additional error in depth.
constexpr double kTrackedNoiseFactor = 2.0;
constexpr double kUnknownTrust = 0.5;
// Seconds that memory bridges where few points are found again, and what share is few.
constexpr double kMemory = 0.5;
constexpr double kMinKept = 0.25;
constexpr double kTrustRate = 0.3;        // of the way to 0 or 1 per frame
constexpr double kMinTrustWeight = 0.05;  // so that a wrong static scene can be corrected
// px of 640 x 480, within which points of a surface share trust. Images of any size have about as
// many points, and as many of them within an eighth of their width.
constexpr double kInheritRadius = 80.0;
constexpr double kInheritDepth = 0.03;  // 1/m, likewise
// The prediction is uncertain far from the inliers that determine the camera's motion.
constexpr double kMaxUncertainty = 1.5;  // of epsilon; beyond, a point is not classified
constexpr double kSigmas = 3.0;          // of the prediction, added to the threshold

Eigen::Vector2d vector_of(const cv::Point2f& p) { return {p.x, p.y}; }

Eigen::Vector3d point_of(const cv::Point2f& pixel, const Surface& surface, const Camera& camera) {
  return camera.unproject(pixel.x, pixel.y, 1.0 / surface.inverse_depth);
}

bool measured(const Surface& surface) { return surface.kind == Surface::Kind::kMeasured; }

// Where the camera's motion takes a pixel of a given inverse depth, which may be 0: infinitely far.
struct Prediction {
  Eigen::Vector2d pixel = Eigen::Vector2d::Zero();
  double inverse_depth = 0;  // 1/m
  bool in_front = false;
};

Prediction predicted(const cv::Point2f& pixel, double inverse_depth, const Pose& motion,
                     const Camera& camera) {
  const Eigen::Vector3d p = motion.linear() * camera.unproject(pixel.x, pixel.y, 1.0) +
                            inverse_depth * motion.translation();
  if (p.z() < 1e-3) return {};
  return {camera.project(p), inverse_depth / p.z(), true};
}

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d along = b - a;
  const double squared = along.squaredNorm();
  const double t = squared > 0 ? std::clamp((p - a).dot(along) / squared, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

bool usable_depth(const Frame& frame) {
  return frame.camera && frame.depth.type() == CV_32FC1 && frame.depth.size() == frame.gray.size();
}

}  // namespace

void RgbdChecker::Options::visit(OptionVisitor& v) {
  v("epsilon", epsilon,
    {.min = 0, .unit = "px", .help = "a point with a larger reprojection error moves"});
  v("noise_multiple", noise_multiple,
    {.min = 0, .help = "epsilon is at least this many median residuals of the static points"});
  v("pixel_noise", pixel_noise,
    {.min = 0.01, .unit = "px", .help = "standard deviation of a tracked point"});
  surface.visit(v);
  follow.visit(v);
  v("samples", samples, {.min = 1, .max = 100000, .help = "samples of RANSAC, three matches each"});
  v("min_matches", min_matches,
    {.min = 6,
     .max = 100000,
     .help = "matches with depth that are needed; with fewer the check is not reliable"});
  v("min_agreement", min_agreement,
    {.min = 0, .max = 1, .help = "with a smaller inlier share the check is not reliable"});
  v("min_depth", min_depth,
    {.min = 0.01, .unit = "m", .help = "nearest place where a point without depth can be"});
  v("usual_depth", usual_depth,
    {.min = 0.1,
     .unit = "m",
     .help = "likely depth of points without a measurement; their motion is predicted with it"});
  v("max_ambiguity", max_ambiguity,
    {.min = 0,
     .unit = "px",
     .help = "a point without depth is classified only when the segment of the epipolar line on "
             "which it may lie is shorter"});
}

MovingPoints RgbdChecker::check(const Frame& previous, const Frame& current,
                                const TrackingHistory&) {
  const bool is_next = memory_.frame == previous.index;
  const double age = previous.time - memory_.time;
  if (!is_next && (age < 0 || age > kMemory)) memory_ = {};
  std::vector<Observation> observations = observe(previous, current);
  MovingPoints result;
  for (const Observation& o : observations)
    result.points.push_back({.previous = o.match.previous, .current = o.match.current});
  const auto motion = camera_motion(observations, current);
  if (motion) {
    result.camera_motion = motion->target_from_source;
    classify(observations, *motion, *current.camera, result);
    search_from_prediction(observations, motion->target_from_source, current, result);
  }
  remember(observations, result, motion ? motion->target_from_source : memory_.motion, current);
  return result;
}

RigidNoise RgbdChecker::noise_of(const Camera& camera) const {
  return {.pixel = options_.pixel_noise,
          .inverse_depth = kTrackedNoiseFactor * camera.surface_noise};
}

Surface RgbdChecker::surface_in(const Frame& frame, const cv::Point2f& pixel) const {
  return surface_at(frame.depth, pixel, noise_of(*frame.camera).inverse_depth, options_.surface);
}

std::vector<RgbdChecker::Observation> RgbdChecker::observe(const Frame& previous,
                                                           const Frame& current) {
  std::vector<Observation> result;
  const bool with_depth = usable_depth(previous) && usable_depth(current);
  // Of an older frame, places are known roughly: new points there take the trust of the old ones.
  const bool is_fresh = memory_.frame == previous.index;
  const std::vector<cv::Point2f> kept = is_fresh ? memory_.points : std::vector<cv::Point2f>();
  for (const Match& match : follower_.follow(previous, current, kept)) {
    Observation observation{.match = match};
    if (with_depth) {
      observation.from = surface_in(previous, match.previous);
      observation.to = surface_in(current, match.current);
    }
    result.push_back(observation);
  }
  const double radius = kInheritRadius * pixel_scale(current.gray.size());
  for (Observation& o : result)
    o.trust =
        o.match.kept_index >= 0 ? memory_.trust[o.match.kept_index] : inherited_trust(o, radius);
  return result;
}

// New points take the mean trust of their neighbours on the same surface.
double RgbdChecker::inherited_trust(const Observation& observation, double radius) const {
  double sum = kUnknownTrust;
  double weights = 1.0;
  for (std::size_t i = 0; i < memory_.points.size(); ++i) {
    if (std::abs(memory_.inverse_depth[i] - observation.from.inverse_depth) > kInheritDepth)
      continue;
    const cv::Point2f apart = memory_.points[i] - observation.match.previous;
    if (apart.dot(apart) > radius * radius) continue;
    sum += memory_.trust[i];
    weights += 1.0;
  }
  return sum / weights;
}

std::optional<RigidMotion> RgbdChecker::camera_motion(const std::vector<Observation>& observations,
                                                      const Frame& current) const {
  std::vector<RigidMatch> matches;
  for (const Observation& o : observations) {
    if (!measured(o.from) || !measured(o.to)) continue;
    matches.push_back({point_of(o.match.previous, o.from, *current.camera),
                       point_of(o.match.current, o.to, *current.camera), vector_of(o.match.current),
                       std::max(kMinTrustWeight, o.trust)});
  }
  if (matches.size() < static_cast<std::size_t>(options_.min_matches)) return std::nullopt;
  const std::array<Pose, 2> guesses = {Pose::Identity(), memory_.motion};
  auto motion = find_rigid_motion(matches, *current.camera, noise_of(*current.camera), guesses,
                                  options_.samples, seed_ + current.index);
  if (!motion || motion->agreement < options_.min_agreement ||
      motion->inliers < options_.min_matches / 2)
    return std::nullopt;
  return motion;
}

void RgbdChecker::classify(std::vector<Observation>& observations, const RigidMotion& motion,
                           const Camera& camera, MovingPoints& result) const {
  const Pose& pose = motion.target_from_source;
  const RigidNoise noise = noise_of(camera);
  const double pixels_per_depth = noise.pixel / (noise.inverse_depth * std::sqrt(2.0));
  std::vector<double> uncertainty;  // px, of the predicted pixel
  std::vector<double> static_residuals;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    Observation& o = observations[i];
    const double slack = 2 * noise.inverse_depth;
    const bool known = o.from.kind != Surface::Kind::kNone;
    const double far = known ? std::max(0.0, o.from.inverse_depth - slack) : 0.0;
    const double near = known ? o.from.inverse_depth + slack : 1.0 / options_.min_depth;
    const Prediction at_far = predicted(o.match.previous, far, pose, camera);
    const Prediction at_near = predicted(o.match.previous, near, pose, camera);
    const bool placed = at_far.in_front && at_near.in_front &&
                        (known || (at_far.pixel - at_near.pixel).norm() <= options_.max_ambiguity);
    const double z = known ? 1.0 / o.from.inverse_depth : options_.usual_depth;
    uncertainty.push_back(pixel_uncertainty(
        motion, camera, camera.unproject(o.match.current.x, o.match.current.y, z)));
    o.is_predictable = placed && o.from.kind != Surface::Kind::kEdge &&
                       o.to.kind != Surface::Kind::kEdge &&
                       uncertainty.back() <= kMaxUncertainty * options_.epsilon;
    if (!placed) continue;
    double residual = distance_to_segment(vector_of(o.match.current), at_far.pixel, at_near.pixel);
    if (measured(o.from) && measured(o.to)) {
      const double expected =
          predicted(o.match.previous, o.from.inverse_depth, pose, camera).inverse_depth;
      residual = std::hypot(residual, pixels_per_depth * (expected - o.to.inverse_depth));
    }
    result.points[i].residual = static_cast<float>(residual);
    if (o.is_predictable && residual < options_.epsilon) static_residuals.push_back(residual);
  }
  if (static_cast<int>(static_residuals.size()) < options_.min_matches / 2) return;
  const double limit =
      std::max(options_.epsilon, options_.noise_multiple * median(static_residuals));
  for (std::size_t i = 0; i < observations.size(); ++i)
    result.points[i].moving =
        observations[i].is_predictable &&
        result.points[i].residual > std::hypot(limit, kSigmas * uncertainty[i]);
  result.reliable = true;
}

// Optical flow may drift off its point, far when the image moves fast. A point that is found when
// searched for from its static prediction is static.
void RgbdChecker::search_from_prediction(std::vector<Observation>& observations, const Pose& motion,
                                         const Frame& current, MovingPoints& result) const {
  std::vector<std::size_t> suspects;
  std::vector<cv::Point2f> points;
  std::vector<cv::Point2f> expected;
  for (std::size_t i = 0; i < observations.size(); ++i) {
    if (!result.points[i].moving) continue;
    const Match& match = observations[i].match;
    const Prediction at =
        predicted(match.previous, observations[i].from.inverse_depth, motion, *current.camera);
    if ((vector_of(match.current) - at.pixel).norm() <= options_.epsilon) continue;  // in depth
    suspects.push_back(i);
    points.push_back(match.previous);
    expected.emplace_back(static_cast<float>(at.pixel.x()), static_cast<float>(at.pixel.y()));
  }
  const auto found = follower_.follow_from(points, expected);
  for (std::size_t k = 0; k < suspects.size(); ++k) {
    if (!found[k]) continue;
    const double residual = cv::norm(*found[k] - expected[k]);
    if (residual > options_.epsilon) continue;
    PointMotion& point = result.points[suspects[k]];
    point = {.previous = points[k],
             .current = *found[k],
             .residual = static_cast<float>(residual),
             .moving = false};
    Observation& observation = observations[suspects[k]];
    observation.match.current = *found[k];
    observation.to = surface_in(current, *found[k]);
  }
}

void RgbdChecker::remember(const std::vector<Observation>& observations, const MovingPoints& result,
                           const Pose& motion, const Frame& frame) {
  const double enough = kMinKept * static_cast<double>(memory_.points.size());
  if (static_cast<double>(observations.size()) < enough) return;  // a jump of exposure, or a gap
  Memory memory{.frame = frame.index,
                .time = frame.time,
                .motion = motion,
                .points = {},
                .inverse_depth = {},
                .trust = {}};
  for (std::size_t i = 0; i < observations.size(); ++i) {
    const Observation& o = observations[i];
    if (o.from.kind == Surface::Kind::kEdge || o.to.kind == Surface::Kind::kEdge) continue;
    const bool is_classified = result.reliable && o.is_predictable;
    const double goal = !is_classified ? o.trust : result.points[i].moving ? 0.0 : 1.0;
    memory.points.push_back(o.match.current);
    memory.inverse_depth.push_back(o.to.inverse_depth);
    memory.trust.push_back(o.trust + kTrustRate * (goal - o.trust));
  }
  memory_ = std::move(memory);
}

}  // namespace stillpoint::moving_checks
