// Contract: class labels for an image (paper III-B). Thread 2.
#pragma once

#include <cstdint>
#include "stillpoint/class_names.hpp"
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Says what could move. Frames are valid during the call; a copy may be kept.
class STILLPOINT_EXPORT Segmenter {
 public:
  static constexpr const char* kKind = "segmenter";
  static constexpr std::uint32_t kApi = 1;  ///< see kPluginApi
  virtual ~Segmenter();

  /// What its labels mean, always the same: 2 to 256 names. Asked several times, first when the
  /// stage has just been made. Other stages learn it from their StageContext.
  virtual ClassNames classes() const = 0;

  /// Labels of the frame's size, or empty labels when this segmenter has none for it, with the
  /// index of the frame. Objects may be left out, together with instances: the runtime finds them
  /// then (stillpoint/support/objects.hpp). With `schedule: wait` called for every frame, in order;
  /// with `latest` for the newest one when the call before has ended.
  virtual Segmentation segment(const Frame& frame) = 0;
};

}  // namespace stillpoint
