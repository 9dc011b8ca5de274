// Contract: class labels for an image (paper III-B). Thread 2.
#pragma once

#include <cstdint>
#include "stillpoint/class_names.hpp"
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

class STILLPOINT_EXPORT Segmenter {
 public:
  static constexpr const char* kKind = "segmenter";
  static constexpr std::uint32_t kApi = 1;  ///< see kPluginApi
  virtual ~Segmenter();

  /// What its labels mean. Other stages learn it from their StageContext.
  virtual ClassNames classes() const = 0;

  /// Labels of the frame's size, or empty labels when this segmenter has none for it. Objects may
  /// be left out: the runtime finds them then (stillpoint/support/objects.hpp).
  virtual Segmentation segment(const Frame& frame) = 0;
};

}  // namespace stillpoint
