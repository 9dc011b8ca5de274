// Contract: which points move by themselves (paper III-C, Algorithm 1). Beside thread 1.
#pragma once

#include <cstdint>
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

class STILLPOINT_EXPORT MovingChecker {
 public:
  static constexpr const char* kKind = "moving_checker";
  static constexpr std::uint32_t kApi = 1;  ///< see kPluginApi
  virtual ~MovingChecker();

  /// Both frames have the same size.
  virtual MovingPoints check(const Frame& previous, const Frame& current) = 0;
};

}  // namespace stillpoint
