#include "simulation/noise.hpp"

#include <array>
#include <cmath>

namespace stillpoint::simulation {
namespace {

constexpr int kQuantiles = 4096;

std::array<float, kQuantiles> make_quantiles() {
  std::array<float, kQuantiles> table{};
  for (int i = 0; i < kQuantiles; ++i) {
    const double probability = (i + 0.5) / kQuantiles;
    double low = -6;
    double high = 6;
    for (int step = 0; step < 40; ++step) {
      const double middle = 0.5 * (low + high);
      (0.5 * std::erfc(-middle * M_SQRT1_2) < probability ? low : high) = middle;
    }
    table[static_cast<std::size_t>(i)] = static_cast<float>(low);
  }
  return table;
}

const std::array<float, kQuantiles> kNormalQuantiles = make_quantiles();

}  // namespace

float normal_from_bits(std::uint32_t bits) { return kNormalQuantiles[bits >> 20]; }

}  // namespace stillpoint::simulation
