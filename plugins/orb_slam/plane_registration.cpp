#include "orb_slam/plane_registration.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace stillpoint::orb_slam {
namespace {

constexpr int kStride = 2;            // every other patch of every other row
constexpr float kMinCosine = 0.87F;   // between normals: 30 degrees
constexpr float kBounds = 3.0F;       // standard deviations
constexpr double kNoiseMargin = 2.0;  // times the spurious information from the noise of normals

using Vector6f = Eigen::Matrix<float, 6, 1>;

// Standard deviation in metres of what is no noise of single pixels: walls that are not quite flat,
// and the distortion of depth, which is taken for twice the noise at 1 m; a Kinect's is 2 mm.
constexpr float kFlatness = 0.004F;
constexpr float kDistortion = 2.0F;  // m²: times the noise of the inverse depth
float model_sigma(const DepthView& view) {
  return std::max(kFlatness, kDistortion * view.surface_noise());
}

struct Sums {
  Matrix6d hessian = Matrix6d::Zero();
  Vector6d gradient = Vector6d::Zero();
  double cost = 0.0;
  double weight = 0.0;
  double information = 0.0;        // 1/m²: trace of the part of translation
  double noise_information = 0.0;  // 1/m²: what the noise of normals adds to any direction
  double depth = 0.0;              // sum of information times depth
};

// Another view, with what is needed per patch in single precision.
struct Other {
  Other(const PlacedView& placed, const Pose& camera_from_world) : view(placed.view) {
    const Pose pose = placed.world_from_camera.inverse() * camera_from_world.inverse();
    rotation = pose.linear().cast<float>();
    translation = pose.translation().cast<float>();
  }
  const DepthView* view;
  Eigen::Matrix3f rotation;     // other from current
  Eigen::Vector3f translation;  // metres
};

void add(const DepthView& current, const PlanePatch& patch, const Other& other,
         const PlanePatch& plane, const Eigen::Vector3f& in_other, float reach, Sums& sums,
         PlaneRegistration& result) {
  const Eigen::Vector3f normal = other.rotation.transpose() * plane.normal;  // in current
  if (normal.dot(patch.normal) < kMinCosine) return;
  const float off = plane.normal.dot(in_other - plane.point);
  const float own = current.distance_sigma(patch), theirs = other.view->distance_sigma(plane);
  const float model = model_sigma(current);
  const float variance = own * own + theirs * theirs + model * model;
  if (std::abs(off) > std::max(reach, kBounds * std::sqrt(variance))) return;
  ++result.inlier_count;

  const float trust = patch.weight * plane.weight;
  const float robust = 1.0F / (1.0F + off * off / (kBounds * kBounds * variance));  // Cauchy
  const float information = trust * robust / variance;
  // The point moves by -(translation + rotation × point) when the pose is perturbed on the left.
  Vector6f jacobian;
  jacobian << -normal, -patch.point.cross(normal);
  sums.hessian += (information * jacobian * jacobian.transpose()).cast<double>();
  sums.gradient += (information * off * jacobian).cast<double>();
  sums.cost += information * off * off;
  sums.weight += trust;
  const float tilt = other.view->normal_sigma(plane);
  sums.information += information;
  sums.noise_information += information * tilt * tilt;
  sums.depth += information * patch.point.z();
}

// Solution remapping: keeps the directions that the surfaces constrain. Rotations are compared with
// translations by the displacement that they cause at the mean depth.
void remap_degenerate_directions(Sums& sums) {
  Vector6d scale = Vector6d::Ones();
  scale.tail<3>().setConstant(sums.information / std::max(sums.depth, 1e-9));
  const Matrix6d scaled = scale.asDiagonal() * sums.hessian * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6d> eigen(scaled);
  const double floor = kNoiseMargin * sums.noise_information;
  Matrix6d constrained = Matrix6d::Zero();
  for (int i = 0; i < 6; ++i)
    if (eigen.eigenvalues()[i] > floor)
      constrained += eigen.eigenvectors().col(i) * eigen.eigenvectors().col(i).transpose();
  const Vector6d unscale = scale.cwiseInverse();
  sums.gradient = unscale.asDiagonal() * constrained * scale.asDiagonal() * sums.gradient;
  sums.hessian = unscale.asDiagonal() * constrained * scaled * constrained * unscale.asDiagonal();
}

}  // namespace

PlaneRegistration register_planes(const DepthView& current, std::span<const PlacedView> others,
                                  const Pose& camera_from_world, double reach) {
  std::vector<Other> placed;
  for (const PlacedView& other : others) placed.emplace_back(other, camera_from_world);
  PlaneRegistration result;
  Sums sums;
  for (int row = 0; row < current.rows(); row += kStride) {
    for (int column = 0; column < current.columns(); column += kStride) {
      const PlanePatch& patch = current.patch(column, row);
      if (patch.weight <= 0) continue;
      ++result.patches;
      for (const Other& other : placed) {
        const Eigen::Vector3f in_other = other.rotation * patch.point + other.translation;
        const PlanePatch* plane = other.view->at(in_other);
        if (!plane) continue;
        ++result.matched;
        add(current, patch, other, *plane, in_other, static_cast<float>(reach), sums, result);
        break;
      }
    }
  }
  if (sums.information <= 0) return result;
  remap_degenerate_directions(sums);
  const double share = std::min(1.0, kMaxPatches / sums.weight);
  result.cost = {.linearised_at = camera_from_world,
                 .hessian = share * sums.hessian,
                 .gradient = share * sums.gradient,
                 .constant = share * sums.cost};
  return result;
}

}  // namespace stillpoint::orb_slam
