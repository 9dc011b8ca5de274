#include "stillpoint/support/rigid_motion.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>

namespace stillpoint {
namespace {

constexpr double kBound = 7.815;   // of the squared error: 95 % of chi-square, 3 degrees of freedom
constexpr int kSampleSteps = 2;    // Gauss–Newton, on three matches
constexpr int kRounds = 4;         // of deciding who is an inlier
constexpr int kSteps = 3;          // Gauss–Newton, per round
constexpr double kNearest = 0.05;  // m, in front of the camera

using Matrix36 = Eigen::Matrix<double, 3, 6>;

// d (pixel, inverse depth) / d tangent of the pose at a point in the target camera.
Matrix36 jacobian(const Eigen::Vector3d& p, const Camera& camera) {
  const Eigen::Matrix3d by_point = camera.measurement_jacobian(p);
  Matrix36 result;
  result.leftCols<3>() = by_point;
  result.rightCols<3>() = -by_point * skew(p);
  return result;
}

class Estimator {
 public:
  Estimator(std::span<const RigidMatch> matches, const Camera& camera, const RigidNoise& noise)
      : matches_(matches),
        camera_(camera),
        scale_(1 / noise.pixel, 1 / noise.pixel, 1 / noise.inverse_depth) {}

  // What the pose explains, by weight: the negative cost of MSAC (Torr and Zisserman, CVIU 2000).
  double score(const Pose& pose) const {
    double sum = 0;
    for (const RigidMatch& match : matches_)
      sum += match.weight * std::max(0.0, 1.0 - squared_error(match, pose) / kBound);
    return sum;
  }

  std::optional<Pose> from_sample(const std::array<std::size_t, 3>& sample) const {
    Eigen::Matrix3Xd source(3, 3);
    Eigen::Matrix3Xd target(3, 3);
    for (int i = 0; i < 3; ++i) {
      source.col(i) = matches_[sample[i]].in_source;
      target.col(i) = matches_[sample[i]].in_target;
    }
    Pose pose = align_points(source, target, false).target_from_source;
    for (int step = 0; step < kSampleSteps; ++step) {
      Equations equations;
      for (const std::size_t i : sample) add(matches_[i], pose, 1.0, equations);
      if (!advance(equations, pose)) return std::nullopt;
    }
    return pose;
  }

  // Tukey's biweight within a bound that shrinks: the start may be some pixels off.
  std::optional<RigidMotion> refine(const Pose& start) const {
    RigidMotion motion{.target_from_source = start};
    Matrix6d information = Matrix6d::Zero();
    double bound = 8 * kBound;
    for (int round = 0; round < kRounds; ++round, bound = std::max(kBound, bound / 2))
      for (int step = 0; step < kSteps; ++step) {
        Equations equations;
        for (const RigidMatch& match : matches_) {
          const double fit = 1.0 - squared_error(match, motion.target_from_source) / bound;
          if (fit > 0) add(match, motion.target_from_source, match.weight * fit * fit, equations);
        }
        if (!advance(equations, motion.target_from_source)) return std::nullopt;
        information = equations.hessian;
      }
    motion.covariance = information.llt().solve(Matrix6d::Identity());
    count_inliers(motion);
    return motion;
  }

 private:
  struct Equations {
    Matrix6d hessian = Matrix6d::Zero();
    Vector6d gradient = Vector6d::Zero();
  };

  // In standard deviations; infinite behind the camera.
  Eigen::Vector3d error(const RigidMatch& match, const Eigen::Vector3d& p) const {
    if (p.z() < kNearest) return Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
    const double iz = 1.0 / p.z();
    return scale_.cwiseProduct(Eigen::Vector3d(
        camera_.fx * p.x() * iz + camera_.cx - match.pixel.x(),
        camera_.fy * p.y() * iz + camera_.cy - match.pixel.y(), iz - 1.0 / match.in_target.z()));
  }
  double squared_error(const RigidMatch& match, const Pose& pose) const {
    return error(match, pose * match.in_source).squaredNorm();
  }

  void add(const RigidMatch& match, const Pose& pose, double weight, Equations& equations) const {
    const Eigen::Vector3d p = pose * match.in_source;
    if (p.z() < kNearest) return;
    const Matrix36 j = scale_.asDiagonal() * jacobian(p, camera_);
    equations.hessian.noalias() += weight * (j.transpose() * j);
    equations.gradient.noalias() += weight * (j.transpose() * error(match, p));
  }

  static bool advance(const Equations& equations, Pose& pose) {
    const Eigen::LLT<Matrix6d> factors(equations.hessian);
    if (factors.info() != Eigen::Success) return false;
    const Vector6d step = factors.solve(-equations.gradient);
    if (!step.allFinite()) return false;
    pose = exp_se3(step) * pose;
    return true;
  }

  void count_inliers(RigidMotion& motion) const {
    double all = 0;
    double agreeing = 0;
    for (const RigidMatch& match : matches_) {
      const bool fits = squared_error(match, motion.target_from_source) <= kBound;
      motion.inlier.push_back(fits);
      motion.inliers += fits;
      all += match.weight;
      agreeing += fits ? match.weight : 0.0;
    }
    motion.agreement = all > 0 ? agreeing / all : 0;
  }

  std::span<const RigidMatch> matches_;
  const Camera& camera_;
  Eigen::Vector3d scale_;  // 1 / standard deviation of pixel x, y and inverse depth
};

// Three matches far apart in the image: near ones determine a motion badly and tend to lie on one
// object. Where all of them crowd in a part of the image, they may be nearer.
class Sampler {
 public:
  Sampler(std::span<const RigidMatch> matches, const Camera& camera, std::uint64_t seed)
      : matches_(matches),
        spacing_(camera.width / 8.0),
        least_spacing_(camera.width / 64.0),
        random_(seed) {}

  std::optional<std::array<std::size_t, 3>> draw() {
    for (int attempt = 0; attempt < 20; ++attempt) {
      const std::array<std::size_t, 3> sample = {index(), index(), index()};
      if (apart(sample[0], sample[1]) && apart(sample[1], sample[2]) && apart(sample[0], sample[2]))
        return sample;
    }
    spacing_ = std::max(spacing_ / 2, least_spacing_);
    return std::nullopt;
  }

 private:
  std::size_t index() { return random_() % matches_.size(); }
  bool apart(std::size_t a, std::size_t b) const {
    return (matches_[a].pixel - matches_[b].pixel).norm() >= spacing_;
  }

  std::span<const RigidMatch> matches_;
  double spacing_;        // px
  double least_spacing_;  // px
  std::mt19937_64 random_;
};

}  // namespace

std::optional<RigidMotion> find_rigid_motion(std::span<const RigidMatch> matches,
                                             const Camera& camera, const RigidNoise& noise,
                                             std::span<const Pose> guesses, int samples,
                                             std::uint64_t seed) {
  if (matches.size() < 3) return std::nullopt;
  const Estimator estimator(matches, camera, noise);
  std::optional<Pose> best;
  double best_score = 0;
  const auto compete = [&](const Pose& pose) {
    const double score = estimator.score(pose);
    if (score <= best_score) return;
    best_score = score;
    best = pose;
  };
  for (const Pose& guess : guesses) compete(guess);
  Sampler sampler(matches, camera, seed);
  for (int i = 0; i < samples; ++i) {
    const auto sample = sampler.draw();
    if (!sample) continue;
    if (const auto pose = estimator.from_sample(*sample)) compete(*pose);
  }
  if (!best) return std::nullopt;
  return estimator.refine(*best);
}

double pixel_uncertainty(const RigidMotion& motion, const Camera& camera,
                         const Eigen::Vector3d& point_in_target) {
  const Eigen::Matrix<double, 2, 6> j = jacobian(point_in_target, camera).topRows<2>();
  return std::sqrt((j * motion.covariance * j.transpose()).trace());
}

}  // namespace stillpoint
