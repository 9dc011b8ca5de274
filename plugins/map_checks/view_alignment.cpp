#include "map_checks/view_alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

namespace stillpoint {
namespace {

constexpr int kStep = 4;        // cells between the points used
constexpr int kIterations = 4;  // of ICP
constexpr std::size_t kMostViews = 3;
constexpr float kFirstGate = 0.15F;  // m off a surface; later ones are nearer
constexpr float kLastGate = 0.05F;
constexpr float kOnSurface = 0.04F;  // m
// Neighbouring points err together (registration, calibration): so many of them count as one.
constexpr double kCorrelated = 5.0;
constexpr double kSurfaceSigma = 0.01;   // m at 1 m
constexpr double kGuessPosition = 0.05;  // m, standard deviation of the guess
constexpr double kGuessAngle = 0.05;     // rad

struct Normal {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  int on_surface = 0;  // points that lie on a trusted surface
  int behind = 0;      // points seen through one
};

std::vector<Eigen::Vector3f> points_of(const cv::Mat& depth, const CellCamera& camera) {
  std::vector<Eigen::Vector3f> points;
  for (int y = kStep / 2; y < depth.rows; y += kStep)
    for (int x = kStep / 2; x < depth.cols; x += kStep)
      if (const float z = depth.at<float>(y, x); z > 0)
        points.push_back(camera.unproject(static_cast<float>(x), static_cast<float>(y), z));
  return points;
}

class Aligner {
 public:
  Aligner(const std::vector<Eigen::Vector3f>& points, std::span<const View* const> views)
      : points_(points), views_(views.first(std::min(views.size(), kMostViews))) {}

  Normal compare(const Pose& world_from_camera, float gate) const {
    Normal sum;
    for (const View* view : views_) add(*view, world_from_camera, gate, sum);
    return sum;
  }

  Pose refine(const Pose& guess) const {
    Vector6d prior;
    prior.head<3>().setConstant(1 / (kGuessPosition * kGuessPosition));
    prior.tail<3>().setConstant(1 / (kGuessAngle * kGuessAngle));
    Pose pose = guess;
    for (int i = 0; i < kIterations; ++i) {
      const float t = static_cast<float>(i) / (kIterations - 1);
      Normal sum = compare(pose, kFirstGate + t * (kLastGate - kFirstGate));
      // In the camera's frame: pose = guess * exp(offset).
      const Vector6d offset = log_se3(guess.inverse() * pose);
      sum.hessian.diagonal() += prior;
      sum.gradient += prior.cwiseProduct(offset);
      const Vector6d step = sum.hessian.selfadjointView<Eigen::Lower>().ldlt().solve(-sum.gradient);
      if (!step.allFinite()) return guess;
      pose = pose * exp_se3(step);
    }
    return orthonormalised(pose);
  }

 private:
  void add(const View& view, const Pose& world_from_camera, float gate, Normal& sum) const {
    const Pose view_from_camera = view.world_from_camera.inverse() * world_from_camera;
    const Eigen::Matrix3f rotation = view_from_camera.linear().cast<float>();
    const Eigen::Vector3f translation = view_from_camera.translation().cast<float>();
    const cv::Rect inside({}, view.depth.size());
    for (const Eigen::Vector3f& point : points_) {
      const Eigen::Vector3f p = rotation * point + translation;
      if (p.z() < 0.1F) continue;
      const float u = view.camera.fx * p.x() / p.z() + view.camera.cx;
      const float v = view.camera.fy * p.y() / p.z() + view.camera.cy;
      const cv::Point cell(cvRound(u), cvRound(v));
      if (!inside.contains(cell) || view.trust.at<std::uint8_t>(cell) == kUntrusted) continue;
      const cv::Vec3f& n = view.normals.at<cv::Vec3f>(cell);
      if (n == cv::Vec3f()) continue;
      const Eigen::Vector3f normal(n[0], n[1], n[2]);
      const auto x = static_cast<float>(cell.x), y = static_cast<float>(cell.y);
      const float distance =
          normal.dot(p - view.camera.unproject(x, y, view.depth.at<float>(cell)));
      const float scale = std::max(1.0F, p.z() * p.z() / 4);  // noise grows with the distance
      sum.on_surface += std::abs(distance) < kOnSurface * scale;
      sum.behind += distance <= -kOnSurface * scale;  // normals look at the camera
      const float limit = gate * scale;
      if (std::abs(distance) >= limit) continue;
      // Tukey's weight; d distance / d (translation, rotation) of the camera's own frame.
      const float share = distance / limit;
      const double tukey = (1 - share * share) * (1 - share * share);
      const double sigma = kSurfaceSigma * std::max(1.0, double(p.z()) * p.z() / 2);
      const double weight = tukey / (kCorrelated * sigma * sigma);
      Vector6d jacobian;
      const Eigen::Vector3f in_camera = rotation.transpose() * normal;
      jacobian.head<3>() = in_camera.cast<double>();
      jacobian.tail<3>() = point.cross(in_camera).cast<double>();
      sum.hessian.selfadjointView<Eigen::Lower>().rankUpdate(jacobian, weight);
      sum.gradient.noalias() += weight * distance * jacobian;
    }
  }

  const std::vector<Eigen::Vector3f>& points_;
  std::span<const View* const> views_;
};

// What stands before a surface may have come in, but nothing is seen through one that has not gone.
double agreement(const Normal& sum) {
  constexpr double kFewest = 50;  // points
  return sum.on_surface / std::max(kFewest, static_cast<double>(sum.on_surface + sum.behind));
}

}  // namespace

ViewAlignment align(const cv::Mat& depth, const CellCamera& camera, std::span<const Pose> guesses,
                    std::span<const View* const> views) {
  const std::vector<Eigen::Vector3f> points = points_of(depth, camera);
  const Aligner aligner(points, views);
  const Pose* best = &guesses.front();
  int most = -1;
  for (const Pose& guess : guesses) {
    const int on_surface = aligner.compare(guess, kFirstGate).on_surface;
    if (on_surface <= most) continue;
    best = &guess;
    most = on_surface;
  }
  const Pose refined = aligner.refine(*best);
  const Normal at_refined = aligner.compare(refined, kLastGate);
  if (at_refined.on_surface >= most) return {refined, agreement(at_refined)};
  return {*best, agreement(aligner.compare(*best, kLastGate))};
}

}  // namespace stillpoint
