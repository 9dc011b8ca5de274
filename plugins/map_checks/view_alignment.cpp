#include "map_checks/view_alignment.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <array>
#include <cmath>

#include "stillpoint/contracts/camera.hpp"

namespace stillpoint::map_checks {
namespace {

constexpr int kStep = 4;        // cells between the points used
constexpr int kIterations = 4;  // of ICP
constexpr std::size_t kMaxAlignedViews = 3;
// Association gates in metres at up to 2 m (spread_at): from the error of a predicted pose, 5 cm
// and 0.05 rad at 2 m, to six times the noise of depth, a Kinect's.
constexpr float kFirstGate = 0.15F;
constexpr float kLastGate = 0.05F;
constexpr float kOnSurface = 0.04F;  // m, likewise: five times the noise
constexpr auto kKinectNoise = static_cast<float>(Camera{}.surface_noise);
// Errors of neighbouring points are correlated (registration, calibration): so many count as one.
constexpr double kCorrelated = 5.0;
// m at up to 1.4 m, for a Kinect: noise of its depth (3 mm, Khoshelham and Elberink 2012) and what
// is left of the error of registration and of the view's own pose.
constexpr double kSurfaceSigma = 0.01;
constexpr double kGuessPosition = 0.05;  // m, standard deviation of the guess
constexpr double kGuessAngle = 0.05;     // rad
// m and rad: what depth may be off from a tracked pose. More would follow a person who was not
// recognised.
constexpr double kMaxOffset = 0.025;

struct Fit {
  int on_surface = 0;  // points that lie on a trusted surface
  int behind = 0;      // points behind one, which should be occluded
};

struct Normal {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
};

// Noise grows with the distance.
float spread_at(float z) { return std::max(1.0F, z * z / 4); }

// Of distances from surfaces, relative to a Kinect's: half of the gates is for the noise of the
// sensor, half for the error of registration and poses, which another sensor does not change.
float spread_of(const CellCamera& camera) {
  constexpr float kMost = 4.0F;  // beyond it, a gate would hold several surfaces
  return std::min(kMost, (1.0F + camera.surface_noise / kKinectNoise) / 2.0F);
}

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
  Aligner(const std::vector<Eigen::Vector3f>& points, const CellCamera& camera,
          std::span<const View* const> views)
      : points_(points),
        spread_(spread_of(camera)),
        views_(views.first(std::min(views.size(), kMaxAlignedViews))) {}

  Fit compare(const Pose& world_from_camera) const {
    Fit fit;
    for_each_surface(world_from_camera, [&](const Surface& surface) {
      const float reach = kOnSurface * spread_ * spread_at(surface.z);
      fit.on_surface += std::abs(surface.distance) < reach;
      fit.behind += surface.distance <= -reach;  // normals look at the camera
    });
    return fit;
  }

  Pose refine(const Pose& guess) const {
    Vector6d prior;
    prior.head<3>().setConstant(1 / (kGuessPosition * kGuessPosition));
    prior.tail<3>().setConstant(1 / (kGuessAngle * kGuessAngle));
    Pose pose = guess;
    for (int i = 0; i < kIterations; ++i) {
      const float t = static_cast<float>(i) / (kIterations - 1);
      const float last = kLastGate * spread_, first = std::max(kFirstGate, last);
      Normal sum = normal_equations(pose, first + t * (last - first));
      // In the camera's frame: pose = guess * exp(offset).
      const Vector6d offset = log_se3(guess.inverse() * pose);
      sum.hessian.diagonal() += prior;
      sum.gradient += prior.cwiseProduct(offset);
      const Vector6d step = sum.hessian.ldlt().solve(-sum.gradient);
      if (!step.allFinite()) return guess;
      pose = pose * exp_se3(step);
    }
    return orthonormalised(pose);
  }

 private:
  // A point of the frame, and the trusted surface of a view that it falls on.
  struct Surface {
    const Eigen::Vector3f& point;  // in the camera
    Eigen::Vector3f normal;        // in the camera, towards it
    float z;                       // m, from the view
    float distance;                // m, of the point before the surface
  };

  template <class Visit>
  void for_each_surface(const Pose& world_from_camera, const Visit& visit) const {
    for (const View* view : views_) {
      const Pose view_from_camera = view->world_from_camera.inverse() * world_from_camera;
      const Eigen::Matrix3f rotation = view_from_camera.linear().cast<float>();
      const Eigen::Vector3f translation = view_from_camera.translation().cast<float>();
      const cv::Rect inside({}, view->depth.size());
      for (const Eigen::Vector3f& point : points_) {
        const Eigen::Vector3f p = rotation * point + translation;
        if (p.z() < 0.1F) continue;
        const float u = view->camera.fx * p.x() / p.z() + view->camera.cx;
        const float v = view->camera.fy * p.y() / p.z() + view->camera.cy;
        const cv::Point cell(cvRound(u), cvRound(v));
        if (!inside.contains(cell) || view->trust.at<int>(cell) == kNotStatic) continue;
        const cv::Vec3f& n = view->normals.at<cv::Vec3f>(cell);
        if (n == cv::Vec3f()) continue;
        const Eigen::Vector3f normal(n[0], n[1], n[2]);
        const auto x = static_cast<float>(cell.x), y = static_cast<float>(cell.y);
        const Eigen::Vector3f seen = view->camera.unproject(x, y, view->depth.at<float>(cell));
        visit(Surface{point, rotation.transpose() * normal, p.z(), normal.dot(p - seen)});
      }
    }
  }

  Normal normal_equations(const Pose& world_from_camera, float gate) const {
    Normal sum;
    for_each_surface(world_from_camera, [&](const Surface& surface) {
      const float limit = gate * spread_at(surface.z);
      if (std::abs(surface.distance) >= limit) return;
      // Tukey's weight; d distance / d (translation, rotation) of the camera's own frame.
      const float share = surface.distance / limit;
      const double tukey = (1 - share * share) * (1 - share * share);
      const double sigma =
          kSurfaceSigma * spread_ * std::max(1.0, double(surface.z) * surface.z / 2);
      const double weight = tukey / (kCorrelated * sigma * sigma);
      Vector6d jacobian;
      jacobian.head<3>() = surface.normal.cast<double>();
      jacobian.tail<3>() = surface.point.cross(surface.normal).cast<double>();
      const Vector6d weighted = weight * jacobian;
      sum.hessian.noalias() += weighted * jacobian.transpose();
      sum.gradient.noalias() += surface.distance * weighted;
    });
    return sum;
  }

  const std::vector<Eigen::Vector3f>& points_;
  float spread_;
  std::span<const View* const> views_;
};

// Points in front of a surface may be dynamic objects; points behind it indicate a wrong
// pose, unless the surface is gone.
double agreement(const Fit& fit) {
  constexpr double kMinPoints = 50;  // points
  return fit.on_surface / std::max(kMinPoints, static_cast<double>(fit.on_surface + fit.behind));
}

}  // namespace

ViewAlignment align(const cv::Mat& depth, const CellCamera& camera, std::span<const Pose> guesses,
                    std::span<const View* const> views) {
  const std::vector<Eigen::Vector3f> points = points_of(depth, camera);
  const Aligner aligner(points, camera, views);
  const Pose* best = &guesses.front();
  int most = -1;
  for (const Pose& guess : guesses) {
    const int on_surface = aligner.compare(guess).on_surface;
    if (on_surface <= most) continue;
    best = &guess;
    most = on_surface;
  }
  const Pose refined = aligner.refine(*best);
  const Fit at_refined = aligner.compare(refined);
  if (at_refined.on_surface >= most) return {refined, agreement(at_refined)};
  return {*best, agreement(aligner.compare(*best))};
}

Pose tracked_from_depth(const View& view, std::span<const View* const> others,
                        double min_agreement) {
  cv::Mat static_depth = view.depth.clone();
  static_depth.setTo(0, view.trust == static_cast<int>(kNotStatic));
  const Pose& tracked = view.world_from_camera;
  const ViewAlignment alignment = align(static_depth, view.camera, {&tracked, 1}, others);
  if (alignment.agreement < min_agreement) return Pose::Identity();
  const Vector6d offset = log_se3(tracked.inverse() * alignment.world_from_camera);
  const double size = std::max(offset.head<3>().norm(), offset.tail<3>().norm());
  return exp_se3(offset * (kMaxOffset / std::max(size, kMaxOffset)));
}

}  // namespace stillpoint::map_checks
