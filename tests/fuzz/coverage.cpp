#include "fuzz/coverage.hpp"

#include <array>
#include <bit>
#include <cstdint>

extern "C" const char __executable_start;  // of the linker: where the program lies this time

namespace stillpoint::testing {
namespace {

constexpr std::size_t kSize = 1 << 16;
std::array<std::uint8_t, kSize> taken;   // times, of the run under way
std::array<std::uint16_t, kSize> known;  // bit i: taken by some run so often that it is in class i
std::uintptr_t before = 0;

}  // namespace

void begin_coverage() {
  taken.fill(0);
  before = 0;
}

std::size_t new_coverage() {
  std::size_t found = 0;
  for (std::size_t i = 0; i < kSize; ++i) {
    if (taken[i] == 0) continue;
    const int times = taken[i] < 4 ? taken[i] : std::bit_width(taken[i]) + 1;
    const auto bit = static_cast<std::uint16_t>(1 << times);
    if (known[i] & bit) continue;
    known[i] |= bit;
    ++found;
  }
  return found;
}

extern "C" void __sanitizer_cov_trace_pc() {
  const auto here = reinterpret_cast<std::uintptr_t>(__builtin_return_address(0)) -
                    reinterpret_cast<std::uintptr_t>(&__executable_start);
  std::uint8_t& times = taken[(here ^ (before * 31)) % kSize];
  if (times < 255) ++times;
  before = here;
}

}  // namespace stillpoint::testing
