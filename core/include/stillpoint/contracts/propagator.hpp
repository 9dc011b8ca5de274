// Contract: brings labels of an older frame to the current one. Beside thread 1; in a pipeline with
// neither moving checker nor map checker, on thread 1.
#pragma once

#include <cstdint>
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Keeps tracking from waiting for a segmenter. Frames are valid during the call; a copy may be
/// kept.
class STILLPOINT_EXPORT Propagator {
 public:
  static constexpr const char* kKind = "propagator";
  static constexpr std::uint32_t kApi = 1;  ///< see kPluginApi
  virtual ~Propagator();

  /// `segmentation` belongs to `from`; the result to `to`, and has its index. Called once per
  /// frame, in order, with the newest labels there are: the same ones until there are newer ones.
  /// `from` and `to` can be the same frame, and labels can be empty. Objects must be given: the
  /// runtime finds them for segmenters only.
  virtual Segmentation propagate(const Segmentation& segmentation, const Frame& from,
                                 const Frame& to) = 0;
};

}  // namespace stillpoint
