#include "simulation/walking_path.hpp"

#include <cmath>

namespace stillpoint::simulation {
namespace {

Eigen::Vector2d catmull_rom(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                            const Eigen::Vector2d& c, const Eigen::Vector2d& d, double t) {
  return 0.5 * ((2 * b) + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t * t +
                (3 * b - a - 3 * c + d) * t * t * t);
}

}  // namespace

WalkingPath::WalkingPath(const std::vector<double>& points) {
  constexpr int kFine = 2000;  // steps per piece, small against kStep
  const std::size_t count = points.size() / 2;
  const auto point = [&](std::size_t i) {
    return Eigen::Vector2d(points[2 * (i % count)], points[2 * (i % count) + 1]);
  };
  samples_.push_back(point(0));
  double since_sample = 0;
  Eigen::Vector2d last = point(0);
  for (std::size_t i = 0; i < count; ++i) {
    for (int k = 1; k <= kFine; ++k) {
      const Eigen::Vector2d next = catmull_rom(point(i + count - 1), point(i), point(i + 1),
                                               point(i + 2), static_cast<double>(k) / kFine);
      since_sample += (next - last).norm();
      last = next;
      if (since_sample < kStep) continue;
      samples_.push_back(next);
      since_sample -= kStep;
    }
  }
}

Eigen::Vector2d WalkingPath::at(double way) const {
  const double place = way / kStep;
  const double low = std::floor(place);
  const auto count = static_cast<double>(samples_.size());
  const auto i = static_cast<std::size_t>(low - count * std::floor(low / count)) % samples_.size();
  return samples_[i] + (place - low) * (samples_[(i + 1) % samples_.size()] - samples_[i]);
}

double WalkingPath::heading(double way) const {
  constexpr double kAhead = 0.25;  // metres
  const Eigen::Vector2d direction = at(way + kAhead) - at(way - kAhead);
  return std::atan2(direction.y(), direction.x());
}

}  // namespace stillpoint::simulation
