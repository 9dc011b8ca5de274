#include "people/walk.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace stillpoint::people {
namespace {

constexpr double kGettingUp = 1.2;   // s
constexpr double kStepLength = 0.7;  // m
constexpr double kWalking = 0.35;    // m/s from which legs swing fully

double time_in_walk(const PersonPlan& plan, double time) {
  const double begin = plan.walk.front();
  const double end = plan.walk[plan.walk.size() - 3];
  if (!plan.again || time < end || end <= begin) return time;
  return begin + std::fmod(time - begin, end - begin);
}

double smooth(double share) {
  share = std::clamp(share, 0.0, 1.0);
  return share * share * (3 - 2 * share);
}

double seated_at(const std::vector<double>& sits, double time) {
  double seated = 0;
  for (std::size_t i = 0; i + 1 < sits.size(); i += 2) {
    const double down = smooth((time - sits[i]) / kGettingUp);
    const double up = smooth((sits[i + 1] - time) / kGettingUp);
    seated = std::max(seated, std::min(down, up));
  }
  return seated;
}

/// Metres walked since the beginning of the timetable.
double way_until(const std::vector<double>& walk, double time) {
  double way = 0;
  for (std::size_t i = 3; i < walk.size(); i += 3) {
    const double share = std::clamp((time - walk[i - 3]) / (walk[i] - walk[i - 3]), 0.0, 1.0);
    way += share * std::hypot(walk[i + 1] - walk[i - 2], walk[i + 2] - walk[i - 1]);
  }
  return way;
}

}  // namespace

Eigen::VectorXd at_time(const std::vector<double>& table, int width, double time) {
  const auto step = static_cast<std::size_t>(width);
  const auto row = [&](std::size_t start) {
    return Eigen::Map<const Eigen::VectorXd>(&table[start + 1], width - 1);
  };
  std::size_t next = 0;
  while (next < table.size() && table[next] <= time) next += step;
  if (next == 0) return row(0);
  if (next >= table.size()) return row(table.size() - step);
  const double share = (time - table[next - step]) / (table[next] - table[next - step]);
  return row(next - step) + share * (row(next) - row(next - step));
}

Stance stance_at(const PersonPlan& plan, double time) {
  constexpr double kMoment = 0.15;  // s over which a turn is rounded off
  const double now = time_in_walk(plan, time);
  const Eigen::Vector2d before = at_time(plan.walk, 3, now - kMoment);
  const Eigen::Vector2d after = at_time(plan.walk, 3, now + kMoment);
  const Eigen::Vector2d here = at_time(plan.walk, 3, now);
  Stance stance{.foot = 0.25 * before + 0.5 * here + 0.25 * after};
  stance.seated = seated_at(plan.sits, time);
  stance.walking = std::min(1.0, (after - before).norm() / (2 * kMoment) / kWalking);
  stance.stride = std::numbers::pi * way_until(plan.walk, now) / kStepLength;
  // Who stands still looks where they came from no longer, but where they went.
  for (double moment = now; moment > plan.walk.front() - kMoment; moment -= kMoment) {
    const double step =
        at_time(plan.walk, 3, moment).x() - at_time(plan.walk, 3, moment - kMoment).x();
    if (std::abs(step) < 1e-3) continue;
    stance.to_the_left = step < 0;
    break;
  }
  return stance;
}

}  // namespace stillpoint::people
