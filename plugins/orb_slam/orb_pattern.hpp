// The 256 binary tests of ORB (Rublee et al., ICCV 2011, section 4.3).
#pragma once

#include <array>
#include <cstdint>

namespace stillpoint::orb_slam {

/// Sets its bit when the first point is darker than the second. px from the keypoint, before the
/// rotation by the keypoint's angle.
struct BinaryTest {
  std::int16_t x1, y1, x2, y2;
};

extern const std::array<BinaryTest, 256> kOrbPattern;

/// No point of the pattern is farther from the keypoint, however it is rotated.
inline constexpr int kPatternRadius = 19;

}  // namespace stillpoint::orb_slam
