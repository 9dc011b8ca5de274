#include "figures/range.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "evaluation/format.hpp"

namespace stillpoint::figures {
namespace {

constexpr double kSmallPart = 1e-9;  // of a step: rounding

/// Of the round steps the one that comes closest to `count` ticks.
double tick_step(const Range& range, double count) {
  const double rough = range.span() / std::max(count, 1.0);
  const double power = std::pow(10.0, std::floor(std::log10(rough)));
  double best = power;
  for (const double factor : {2.0, 5.0, 10.0})
    if (factor * power * best < rough * rough) best = factor * power;
  return best;
}

std::string number_text(double value, double step) {
  constexpr double kLargest = 1e7;  // is written out
  if (std::abs(value) >= kLargest) {
    std::ostringstream text;
    text << std::setprecision(3) << value;
    return text.str();
  }
  const int decimals = std::max(0, static_cast<int>(std::ceil(-std::log10(step) - kSmallPart)));
  const std::string digits = evaluation::fixed(std::abs(value), decimals);
  return value < 0 ? "\u2212" + digits : digits;  // a minus, not a hyphen
}

}  // namespace

void Range::include(double value) {
  if (!std::isfinite(value)) return;
  low = std::min(low, value);
  high = std::max(high, value);
}

Range empty_range() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  return {kInfinity, -kInfinity};
}

std::vector<Tick> ticks_of(const Range& range, double count) {
  const double step = tick_step(range, count);
  const double first = std::ceil(range.low / step - kSmallPart),
               last = std::floor(range.high / step + kSmallPart);
  std::vector<Tick> ticks;
  for (double i = first; i <= last; ++i) ticks.push_back({i * step, number_text(i * step, step)});
  return ticks;
}

}  // namespace stillpoint::figures
