#include "floor.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <set>

namespace {

using Points = std::vector<Eigen::Vector3f>;

constexpr int kSamples = 500;            // of three points each
constexpr int kFits = 3;                 // each with the points on the one before
constexpr float kThickness = 0.03F;      // metres, of a surface
constexpr float kMinCosine = 0.7F;       // between a normal and `up`
constexpr float kMinShare = 0.1F;        // of the points, on the plane that says what is horizontal
constexpr float kShareOfLargest = 0.2F;  // of the points of the largest one; less is furniture

/// One point of each cube: as many for the same area, near or far.
Points spread(const Points& points) {
  std::set<std::array<int, 3>> taken;
  Points result;
  for (const Eigen::Vector3f& point : points) {
    const Eigen::Array3i cube = (point.array() / kThickness).floor().cast<int>();
    if (taken.insert({cube.x(), cube.y(), cube.z()}).second) result.push_back(point);
  }
  return result;
}

bool is_on(const Floor& plane, const Eigen::Vector3f& point) {
  return std::abs(plane.up.dot(point) - plane.height) < kThickness / 2;
}

/// The plane with most points, by RANSAC. Its seed is fixed: a map always has the same floor.
std::optional<Floor> largest_plane(const Points& points, const Eigen::Vector3f& up) {
  if (points.empty()) return std::nullopt;
  std::mt19937 random(1);
  const auto draw = [&] { return points[random() % points.size()]; };
  std::optional<Floor> best;
  auto most = static_cast<std::ptrdiff_t>(kMinShare * static_cast<float>(points.size()));
  for (int i = 0; i < kSamples; ++i) {
    const Eigen::Vector3f a = draw(), b = draw(), c = draw();
    Eigen::Vector3f normal = (b - a).cross(c - a).normalized();
    if (normal.dot(up) < 0) normal = -normal;
    if (!(normal.dot(up) > kMinCosine)) continue;  // nor are they on one line
    const Floor plane{.up = normal, .height = normal.dot(a)};
    const auto count =
        std::ranges::count_if(points, [&](const auto& p) { return is_on(plane, p); });
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  return best;
}

/// The plane that fits the points on the given one best, by least squares along its normal.
Floor fitted(const Floor& plane, const Points& points) {
  const Eigen::Vector3f side = plane.up.unitOrthogonal(), other = plane.up.cross(side);
  Eigen::Matrix3f squares = Eigen::Matrix3f::Zero();
  Eigen::Vector3f products = Eigen::Vector3f::Zero();
  for (const Eigen::Vector3f& point : points) {
    if (!is_on(plane, point)) continue;
    const Eigen::Vector3f at(side.dot(point), other.dot(point), 1);
    squares += at * at.transpose();
    products += at * (plane.up.dot(point) - plane.height);
  }
  const Eigen::Vector3f change = squares.inverse() * products;  // two slopes, metres
  const Eigen::Vector3f up = plane.up - change.x() * side - change.y() * other;
  return {.up = up.normalized(), .height = (plane.height + change.z()) / up.norm()};
}

/// Where the lowest large surface is along `up`.
float lowest_level(const Points& points, const Eigen::Vector3f& up) {
  std::vector<float> heights;
  for (const Eigen::Vector3f& point : points) heights.push_back(up.dot(point));
  std::ranges::sort(heights);
  // For each height, how many points are at most the thickness of a surface above it.
  std::vector<std::ptrdiff_t> counts;
  for (auto low = heights.begin(), high = low; low != heights.end(); ++low) {
    high = std::find_if(high, heights.end(), [&](float h) { return h > *low + kThickness; });
    counts.push_back(high - low);
  }
  const auto least = kShareOfLargest * static_cast<float>(*std::ranges::max_element(counts));
  const auto first = std::ranges::find_if(
      counts, [&](std::ptrdiff_t count) { return static_cast<float>(count) >= least; });
  return heights[static_cast<std::size_t>(first - counts.begin() + *first / 2)];
}

}  // namespace

std::optional<Floor> find_floor(const std::vector<Eigen::Vector3f>& points,
                                const Eigen::Vector3f& up) {
  const Points some = spread(points);
  std::optional<Floor> plane = largest_plane(some, up);
  if (!plane) return std::nullopt;
  for (int i = 0; i < kFits; ++i) plane = fitted(*plane, some);
  return Floor{.up = plane->up, .height = lowest_level(some, plane->up)};
}
