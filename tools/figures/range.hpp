// Ranges of numbers, and the round numbers that stand on an axis.
#pragma once

#include <string>
#include <vector>

namespace stillpoint::figures {

struct Range {
  double low, high;
  double span() const { return high - low; }
  double middle() const { return (low + high) / 2; }
  void include(double value);
};

/// The range that includes nothing yet.
Range empty_range();

struct Tick {
  double at;
  std::string text;
};

/// About `count` ticks at multiples of 1, 2 or 5 times a power of ten; all with as many decimals.
std::vector<Tick> ticks_of(const Range& range, double count);

}  // namespace stillpoint::figures
