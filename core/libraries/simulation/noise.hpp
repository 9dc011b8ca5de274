// Random numbers by position instead of by order: the value for a pixel depends on seed, frame and
// pixel only, so that neither the number of threads nor what else is drawn can change it.
#pragma once

#include <cstdint>

namespace stillpoint::simulation {

/// What a random number is for; streams are independent of each other.
enum class Stream : std::uint32_t { kColor, kDepthWhite, kDepthLattice, kDepthJitter };

inline std::uint32_t mix(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352dU;
  x ^= x >> 15;
  x *= 0x846ca68bU;
  return x ^ (x >> 16);
}

/// Random numbers of one image row.
class RowNoise {
 public:
  RowNoise(std::uint32_t seed, std::uint32_t frame, Stream stream, int row)
      : key_(mix(mix(mix(mix(seed) + frame) + static_cast<std::uint32_t>(stream)) +
                 static_cast<std::uint32_t>(row))) {}

  std::uint32_t bits(int column) const {
    return mix(key_ + 0x9e3779b9U * static_cast<std::uint32_t>(column));
  }
  /// Uniform in [0, 1).
  float uniform(int column) const { return static_cast<float>(bits(column) >> 8) * 0x1p-24F; }
  /// Standard normal.
  float normal(int column) const;

 private:
  std::uint32_t key_;
};

/// Standard normal value of random bits, of which the uppermost 12 count.
float normal_from_bits(std::uint32_t bits);

inline float RowNoise::normal(int column) const { return normal_from_bits(bits(column)); }

}  // namespace stillpoint::simulation
