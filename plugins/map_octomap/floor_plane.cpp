#include "map_octomap/floor_plane.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

namespace stillpoint {
namespace {

constexpr double kMinArea = 0.5;         // m², of a floor
constexpr double kShareOfLargest = 0.2;  // of the largest horizontal surface: less is furniture
constexpr double kMaxTilt = 50.0;        // degrees, between the hint and the normal
constexpr int kTrials = 1000;            // of three points; a plane with a tenth of all is found
constexpr std::size_t kSample = 20000;   // points that the trials are judged by

using Points = std::vector<Eigen::Vector3d>;

Points thinned(std::span<const Eigen::Vector3f> points) {
  const std::size_t step = points.size() / kSample + 1;
  Points some;
  for (std::size_t i = 0; i < points.size(); i += step) some.push_back(points[i].cast<double>());
  return some;
}

bool is_on(const Eigen::Vector3d& point, const FloorPlane& plane, double tolerance) {
  return std::abs(plane.up.dot(point) - plane.height) < tolerance;
}

FloorPlane fitted(const Points& points, const FloorPlane& plane, double tolerance) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0;
  for (const Eigen::Vector3d& point : points) {
    if (!is_on(point, plane, tolerance)) continue;
    mean += point;
    squares += point * point.transpose();
    ++count;
  }
  mean /= count;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(squares / count -
                                                            mean * mean.transpose());
  Eigen::Vector3d up = axes.eigenvectors().col(0);
  if (up.dot(plane.up) < 0) up = -up;
  return {.up = up, .height = up.dot(mean)};
}

// RANSAC; its generator is fixed, so that a map always has the same floor.
std::optional<FloorPlane> largest_horizontal(const Points& points, const Eigen::Vector3d& up_hint,
                                             double tolerance) {
  if (points.size() < 3) return std::nullopt;
  std::mt19937 random(1);
  const double min_cosine = std::cos(kMaxTilt * M_PI / 180);
  std::optional<FloorPlane> best;
  std::ptrdiff_t most = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto& a = points[random() % points.size()];
    const auto& b = points[random() % points.size()];
    const auto& c = points[random() % points.size()];
    Eigen::Vector3d up = (b - a).cross(c - a);
    if (up.norm() < tolerance * tolerance) continue;
    up.normalize();
    if (up.dot(up_hint) < 0) up = -up;
    if (up.dot(up_hint) < min_cosine) continue;
    const FloorPlane plane{.up = up, .height = up.dot(a)};
    const auto count = std::count_if(points.begin(), points.end(),
                                     [&](const auto& p) { return is_on(p, plane, tolerance); });
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  if (best) best = fitted(points, *best, tolerance);
  return best;
}

}  // namespace

std::optional<FloorPlane> find_floor_below(std::span<const Eigen::Vector3f> points,
                                           const Eigen::Vector3d& up, double spacing) {
  std::vector<double> heights;
  for (const Eigen::Vector3f& point : points) heights.push_back(up.dot(point.cast<double>()));
  std::sort(heights.begin(), heights.end());
  // Of every height, how many points lie within a voxel above it.
  std::vector<std::size_t> count(heights.size());
  for (std::size_t low = 0, high = 0; low < heights.size(); ++low) {
    while (high < heights.size() && heights[high] <= heights[low] + spacing) ++high;
    count[low] = high - low;
  }
  if (count.empty()) return std::nullopt;
  const double largest = static_cast<double>(*std::max_element(count.begin(), count.end()));
  const double least = std::max(kMinArea / (spacing * spacing), kShareOfLargest * largest);
  const auto found = std::find_if(count.begin(), count.end(),
                                  [&](std::size_t n) { return static_cast<double>(n) >= least; });
  if (found == count.end()) return std::nullopt;
  // The first such height is at the lower edge of the surface: on to where most of it is.
  const auto first = found - count.begin();
  auto peak = first;
  for (auto i = first;
       i < static_cast<std::ptrdiff_t>(count.size()) && heights[i] <= heights[first] + spacing; ++i)
    if (count[i] > count[peak]) peak = i;
  const auto middle = peak + static_cast<std::ptrdiff_t>(count[peak] / 2);
  return FloorPlane{.up = up, .height = heights[middle]};
}

std::optional<FloorPlane> find_floor(std::span<const Eigen::Vector3f> points,
                                     const Eigen::Vector3d& up_hint, double spacing) {
  const Points some = thinned(points);
  const auto horizontal = largest_horizontal(some, up_hint.normalized(), spacing);
  if (!horizontal) return std::nullopt;
  const auto floor = find_floor_below(points, horizontal->up, spacing);
  if (!floor) return std::nullopt;
  // The direction of the floor itself, which is larger than the heights of its voxels are wrong.
  const FloorPlane fit = fitted(some, *floor, spacing);
  const double change = std::acos(std::clamp(fit.up.dot(floor->up), -1.0, 1.0));
  return change < 5 * M_PI / 180 ? fit : *floor;
}

}  // namespace stillpoint
