// Rejects objects that are too small for their class.
#pragma once

#include <optional>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/segmentation.hpp"

namespace stillpoint::segmenter_opencv_dnn {

struct SmallestObject {
  int pixels = 200;
  double area = 0;  ///< m², of the visible surface times the score; 0: any
};

/// In square metres, of the part of the object that is seen, as if it faced the camera. Pixels
/// without a measurement are taken to be as far as the others. Nothing where less than a quarter of
/// the object has depth.
std::optional<double> visible_area(const Segmentation& segmentation, std::size_t object,
                                   const Frame& frame);

/// Makes background of objects that are smaller. Those of unknown area stay.
void remove_small_objects(Segmentation& segmentation, const Frame& frame,
                          const SmallestObject& smallest);

}  // namespace stillpoint::segmenter_opencv_dnn
