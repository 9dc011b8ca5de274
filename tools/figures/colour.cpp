#include "figures/colour.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>

namespace stillpoint::figures {
namespace {

constexpr Colour rgb(std::uint32_t hex) {
  constexpr double kMost = 255;
  return {(hex >> 16) / kMost, ((hex >> 8) & 0xFF) / kMost, (hex & 0xFF) / kMost};
}

constexpr Colour kRuns[kRunColours] = {rgb(0x0072B2), rgb(0xD55E00), rgb(0x009E73),
                                       rgb(0xCC79A7), rgb(0xE69F00), rgb(0x56B4E9)};
constexpr Colour kParts[kPartColours] = {rgb(0x332288), rgb(0x88CCEE), rgb(0x117733),
                                         rgb(0xDDCC77), rgb(0xCC6677), rgb(0x44AA99),
                                         rgb(0xAA4499), rgb(0x999933), rgb(0x882255)};
constexpr Colour kValues[] = {rgb(0x0D0887), rgb(0x46039F), rgb(0x7201A8), rgb(0x9C179E),
                              rgb(0xBD3786), rgb(0xD8576B), rgb(0xED7953), rgb(0xFB9F3A)};

}  // namespace

Colour run_colour(std::size_t index) { return kRuns[index % kRunColours]; }

Colour part_colour(std::size_t index) { return kParts[index % kPartColours]; }

Colour value_colour(double share) {
  constexpr std::size_t kLast = std::size(kValues) - 1;
  const double place = std::clamp(share, 0.0, 1.0) * kLast;
  const std::size_t below = std::min(static_cast<std::size_t>(place), kLast - 1);
  const double t = place - static_cast<double>(below);
  const Colour &a = kValues[below], &b = kValues[below + 1];
  return {std::lerp(a.red, b.red, t), std::lerp(a.green, b.green, t), std::lerp(a.blue, b.blue, t)};
}

}  // namespace stillpoint::figures
