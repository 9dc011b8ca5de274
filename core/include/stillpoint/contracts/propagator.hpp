// Contract: brings labels of an older frame to the current one. Beside thread 1.
#pragma once

#include <cstdint>
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

class STILLPOINT_EXPORT Propagator {
 public:
  static constexpr const char* kKind = "propagator";
  static constexpr std::uint32_t kApi = 1;  ///< see kPluginApi
  virtual ~Propagator();

  /// `segmentation` belongs to `from`; the result to `to`. Called once per frame, in order; `from`
  /// and `to` can be the same frame.
  virtual Segmentation propagate(const Segmentation& segmentation, const Frame& from,
                                 const Frame& to) = 0;
};

}  // namespace stillpoint
