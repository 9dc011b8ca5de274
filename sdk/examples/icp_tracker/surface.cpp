#include "surface.hpp"

#include <cmath>

using stillpoint::Camera;
using stillpoint::Frame;
using stillpoint::Matrix6d;
using stillpoint::Pose;
using stillpoint::Vector6d;

namespace {

constexpr double kLargestStep = 0.05;   // of the depth, between neighbours on one surface
constexpr double kSameDirection = 0.8;  // cosine between normals of correspondences
constexpr int kIterations = 20;
constexpr double kConverged = 1e-5;  // metres and radians
constexpr int kMinCorrespondences = 300;

std::optional<Eigen::Vector3d> point_at(const Frame& frame, int u, int v) {
  if (u < 0 || v < 0 || u >= frame.depth.cols || v >= frame.depth.rows) return {};
  const float depth = frame.depth.at<float>(v, u);
  if (depth <= 0) return {};
  return frame.camera->unproject(u, v, depth);
}

/// Of the plane through the neighbours, towards the camera; zero where they are not on one surface.
Eigen::Vector3d normal_at(const Frame& frame, const Eigen::Vector3d& point, int u, int v,
                          int step) {
  const auto right = point_at(frame, u + step, v), left = point_at(frame, u - step, v);
  const auto below = point_at(frame, u, v + step), above = point_at(frame, u, v - step);
  for (const auto& neighbour : {right, left, below, above})
    if (!neighbour || std::abs(neighbour->z() - point.z()) > kLargestStep * point.z())
      return Eigen::Vector3d::Zero();
  const Eigen::Vector3d normal = (*below - *above).cross(*right - *left).normalized();
  return normal.dot(point) < 0 ? normal : Eigen::Vector3d(-normal);
}

/// Normal equations of the point-to-plane distances.
struct Equations {
  Matrix6d matrix = Matrix6d::Zero();
  Vector6d vector = Vector6d::Zero();
  int correspondences = 0;
  double total_weight = 0.0;  // elements, by their weights

  void add(const Eigen::Vector3d& point, const Surface::Element& correspondence, double weight) {
    Vector6d jacobian;
    jacobian << correspondence.normal, point.cross(correspondence.normal);
    const double distance = correspondence.normal.dot(point - correspondence.point);
    // Depth noise grows with the square of the distance.
    const double precision = weight / std::pow(correspondence.point.z(), 4);
    matrix += precision * jacobian * jacobian.transpose();
    vector -= precision * distance * jacobian;
    ++correspondences;
  }
};

Equations equations(const Surface& reference, const Surface& current, const cv::Mat& weights,
                    const Pose& reference_from_current, double reach) {
  Equations equations;
  for (const Surface::Element& element : current.elements()) {
    if (!element.known()) continue;
    const double weight =
        weights.empty() ? 1.0 : weights.at<std::uint8_t>(element.v, element.u) / 255.0;
    equations.total_weight += weight;
    const Eigen::Vector3d point = reference_from_current * element.point;
    const Surface::Element* correspondence = reference.seen_at(point);
    if (!correspondence || weight == 0 || (correspondence->point - point).norm() > reach) continue;
    const Eigen::Vector3d normal = reference_from_current.linear() * element.normal;
    if (normal.dot(correspondence->normal) > kSameDirection)
      equations.add(point, *correspondence, weight);
  }
  return equations;
}

}  // namespace

Surface::Surface(const Frame& frame, int step)
    : camera_(*frame.camera),
      step_(step),
      columns_(frame.depth.cols / step),
      rows_(frame.depth.rows / step),
      elements_(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_)) {
  for (std::size_t i = 0; i < elements_.size(); ++i) {
    Element& element = elements_[i];
    element.u = static_cast<int>(i) % columns_ * step;
    element.v = static_cast<int>(i) / columns_ * step;
    const auto point = point_at(frame, element.u, element.v);
    if (!point) continue;
    element.point = *point;
    element.normal = normal_at(frame, *point, element.u, element.v, step);
  }
}

const Surface::Element* Surface::seen_at(const Eigen::Vector3d& point_in_camera) const {
  if (point_in_camera.z() <= 0) return nullptr;
  const Eigen::Vector2d pixel = camera_.project(point_in_camera);
  if (!camera_.contains(pixel.x(), pixel.y(), step_)) return nullptr;
  const auto column = std::lround(pixel.x() / step_), row = std::lround(pixel.y() / step_);
  if (column >= columns_ || row >= rows_) return nullptr;
  const Element& element = elements_[static_cast<std::size_t>(row * columns_ + column)];
  return element.known() ? &element : nullptr;
}

std::optional<Registration> registered(const Surface& reference, const Surface& current,
                                       const cv::Mat& weights, const Pose& guess, double reach) {
  Registration result{.reference_from_current = guess};
  for (int i = 0; i < kIterations; ++i) {
    const Equations found =
        equations(reference, current, weights, result.reference_from_current, reach);
    result.correspondences = found.correspondences;
    result.share = found.total_weight > 0 ? found.correspondences / found.total_weight : 0.0;
    if (found.correspondences < kMinCorrespondences) return std::nullopt;
    const Vector6d change = found.matrix.ldlt().solve(found.vector);
    if (!change.allFinite()) return std::nullopt;  // the surfaces do not hold the pose
    result.reference_from_current = stillpoint::exp_se3(change) * result.reference_from_current;
    if (change.norm() < kConverged) break;
  }
  result.reference_from_current = stillpoint::orthonormalised(result.reference_from_current);
  return result;
}
