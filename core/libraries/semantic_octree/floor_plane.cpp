#include "semantic_octree/floor_plane.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <unordered_set>
#include <vector>

namespace stillpoint::semantic_octree {
namespace {

constexpr double kMinArea = 0.5;         // m², of a floor
constexpr double kShareOfLargest = 0.2;  // of the largest horizontal surface: less is furniture
constexpr double kMaxTilt = 50.0;        // degrees, between the hint and the normal
constexpr int kTrials = 5000;            // of three points; 5 hit a plane with a tenth of all
constexpr std::size_t kSample = 10000;   // points that the trials are judged by

using Points = std::span<const Eigen::Vector3f>;

std::vector<Eigen::Vector3f> sample_of(Points points) {
  const std::size_t step = points.size() / (kSample + 1) + 1;
  std::vector<Eigen::Vector3f> sample;
  for (std::size_t i = 0; i < points.size(); i += step) sample.push_back(points[i]);
  return sample;
}

/// Columns and layers along a direction.
class Layers {
 public:
  Layers(std::span<const Eigen::Vector3f> points, const Eigen::Vector3d& up, double edge)
      : up_(up), edge_(edge), side_(up.unitOrthogonal()), other_(up.cross(side_)) {
    for (const Eigen::Vector3f& point : points) occupied_.insert(key_of(point.cast<double>()));
  }

  /// Nothing stands on it, and it goes on in all directions: no wall, no edge.
  bool is_surface(const Eigen::Vector3d& point) const {
    const Key key = key_of(point);
    if (is_occupied({key[0], key[1], key[2] + 1}) || is_occupied({key[0], key[1], key[2] + 2}))
      return false;
    int around = 0;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if ((x != 0 || y != 0) && is_occupied({key[0] + x, key[1] + y, key[2] + z})) {
            ++around;
            break;
          }
    return around >= 6;
  }

 private:
  using Key = std::array<int, 3>;
  struct Hash {
    std::size_t operator()(const Key& key) const {
      return static_cast<std::size_t>(key[0]) * 73856093U ^
             static_cast<std::size_t>(key[1]) * 19349663U ^
             static_cast<std::size_t>(key[2]) * 83492791U;
    }
  };

  Key key_of(const Eigen::Vector3d& point) const {
    const auto cell = [](double place) { return static_cast<int>(std::floor(place)); };
    // Wider than voxels, whose grid may be turned: no column within a surface stays empty.
    const double width = 1.5 * edge_;
    return {cell(side_.dot(point) / width), cell(other_.dot(point) / width),
            cell(up_.dot(point) / edge_)};
  }
  bool is_occupied(const Key& key) const { return occupied_.contains(key); }

  Eigen::Vector3d up_;
  double edge_;
  Eigen::Vector3d side_, other_;
  std::unordered_set<Key, Hash> occupied_;
};

bool is_on(const Eigen::Vector3f& point, const FloorPlane& plane, double tolerance) {
  return std::abs(plane.up.dot(point.cast<double>()) - plane.height) < tolerance;
}

FloorPlane fitted(Points points, const FloorPlane& plane, double tolerance) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double count = 0;
  for (const Eigen::Vector3f& measured : points) {
    if (!is_on(measured, plane, tolerance)) continue;
    const Eigen::Vector3d point = measured.cast<double>();
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
std::optional<FloorPlane> largest_horizontal(Points points, const Eigen::Vector3d& up_hint,
                                             double tolerance) {
  if (points.size() < 3) return std::nullopt;
  std::mt19937 random(1);
  const double min_cosine = std::cos(kMaxTilt * M_PI / 180);
  std::optional<FloorPlane> best;
  std::ptrdiff_t most = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto draw = [&] {
      return Eigen::Vector3d(points[random() % points.size()].cast<double>());
    };
    const Eigen::Vector3d a = draw(), b = draw(), c = draw();
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
  const Layers layers(points, up, spacing);
  for (const Eigen::Vector3f& point : points)
    if (layers.is_surface(point.cast<double>())) heights.push_back(up.dot(point.cast<double>()));
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
  const auto horizontal = largest_horizontal(sample_of(points), up_hint.normalized(), spacing);
  if (!horizontal) return std::nullopt;
  const auto floor = find_floor_below(points, horizontal->up, spacing);
  if (!floor) return std::nullopt;
  // Heights of voxels say little of a direction, unless the surface is large.
  const FloorPlane fit = fitted(points, *floor, spacing);
  const double change = std::acos(std::clamp(fit.up.dot(floor->up), -1.0, 1.0));
  return change < 5 * M_PI / 180 ? fit : *floor;
}

}  // namespace stillpoint::semantic_octree
