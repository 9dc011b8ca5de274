#include "evaluation/relative_error.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "evaluation/association.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr double kReferenceIntervals = 2;  // a reference pose farther away in time is none
constexpr double kMaxDeviation = 0.5;      // of a pair from delta, in deltas

constexpr std::pair<DeltaUnit, const char*> kSymbols[] = {
    {DeltaUnit::kSeconds, "s"}, {DeltaUnit::kFrames, "f"}, {DeltaUnit::kMetres, "m"}};

// What `delta` is counted along, for every pose.
std::vector<double> axis_of(const Trajectory& trajectory, DeltaUnit unit) {
  std::vector<double> axis = times_of(trajectory);
  if (unit == DeltaUnit::kFrames) std::iota(axis.begin(), axis.end(), 0.0);
  if (unit == DeltaUnit::kMetres) {
    axis.front() = 0;
    for (std::size_t i = 1; i < axis.size(); ++i)
      axis[i] = axis[i - 1] + (trajectory.poses[i].world_from_camera.translation() -
                               trajectory.poses[i - 1].world_from_camera.translation())
                                  .norm();
  }
  return axis;
}

// Pairs (i, j) of estimated poses that are about `delta` apart along the axis.
std::vector<TimePair> intervals(const std::vector<double>& axis, const Delta& delta) {
  std::vector<TimePair> result;
  for (std::size_t i = 0; i < axis.size(); ++i) {
    const std::size_t j = closest(axis, axis[i] + delta.length);
    if (axis[j] < axis.back()) result.push_back({i, j});
  }
  return result;
}

// As in the script, motions are taken backwards, the earlier pose seen from the later one.
Pose earlier_from_later(const StampedPose& earlier, const StampedPose& later) {
  return later.world_from_camera.inverse() * earlier.world_from_camera;
}

}  // namespace

std::string symbol_of(DeltaUnit unit) {
  return std::ranges::find(kSymbols, unit, &std::pair<DeltaUnit, const char*>::first)->second;
}

DeltaUnit delta_unit_of(const std::string& symbol) {
  for (const auto& [unit, name] : kSymbols)
    if (symbol == name) return unit;
  throw Error(Fault::kUsage, "'" + symbol + "' is not s, f or m", "unit of the relative error");
}

std::optional<RelativeError> relative_error(const Trajectory& reference, const Trajectory& estimate,
                                            const Delta& delta, double offset) {
  const std::vector<double> reference_times = times_of(reference);
  const std::vector<double> estimate_times = times_of(estimate);
  const double max_difference = kReferenceIntervals * median_interval(reference);
  const std::vector<double> axis = axis_of(estimate, delta.unit);
  RelativeError result;
  std::vector<double> translations, rotations;
  for (const auto& [i, j] : intervals(axis, delta)) {
    const double from_time = estimate_times[i] + offset, to_time = estimate_times[j] + offset;
    const StampedPose& from = reference.poses[closest(reference_times, from_time)];
    const StampedPose& to = reference.poses[closest(reference_times, to_time)];
    if (std::abs(from.time - from_time) > max_difference ||
        std::abs(to.time - to_time) > max_difference)
      continue;
    const Pose error = earlier_from_later(estimate.poses[i], estimate.poses[j]).inverse() *
                       earlier_from_later(from, to);
    translations.push_back(error.translation().norm());
    rotations.push_back(rotation_angle(error) * 180.0 / std::numbers::pi);
    result.per_pair.push_back({from_time, translations.back(), rotations.back()});
    result.of_another_interval +=
        std::abs(axis[j] - axis[i] - delta.length) > kMaxDeviation * delta.length;
  }
  if (translations.size() < 2) return std::nullopt;
  result.pairs = translations.size();
  result.translation_m = statistics_of(std::move(translations));
  result.rotation_deg = statistics_of(std::move(rotations));
  return result;
}

}  // namespace stillpoint::evaluation
