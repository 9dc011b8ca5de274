// What could move: class labels per pixel, and the objects they form (paper III-B).
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <vector>

namespace stillpoint {

/// One connected thing of a labelled class.
struct SegmentedObject {
  int id = -1;         ///< stays the same over frames where a stage follows the object; -1: unknown
  int label = 0;       ///< class id, as in Segmentation::labels
  cv::Rect box;        ///< px
  int pixels = 0;      ///< size of its mask
  float score = 1.0f;  ///< confidence in [0, 1]
};

/// Labels of one frame. Empty `labels` mean that nothing is known, not that nothing is there.
struct Segmentation {
  cv::Mat labels;     ///< CV_8UC1, class id per pixel, 0 = background; or empty
  cv::Mat instances;  ///< CV_8UC1, 1 + index into `objects` per pixel, 0 = none; or empty
  std::vector<SegmentedObject> objects;  ///< of `instances`, in their order
  /// Index of the frame that the labels belong to. Set by who makes them; propagators tell by it
  /// whether the labels are new.
  std::uint32_t frame = 0;

  bool known() const { return !labels.empty(); }
};
using SegmentationPtr = std::shared_ptr<const Segmentation>;

}  // namespace stillpoint
