// The objects in a result of the network, with their depth layers.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "propagator_flow_depth/depth_layer.hpp"
#include "propagator_flow_depth/view.hpp"
#include "stillpoint/contracts/segmentation.hpp"

namespace stillpoint::propagator_flow_depth {

/// An object of the result; or a separate surface in front of the larger part of one: a mask that
/// has leaked onto the desk or the floor still contains its person, and of two people with one mask
/// the nearer may be the smaller. What lies behind the larger part is taken for background.
struct FoundObject {
  int label = 0;
  float score = 1.0f;
  cv::Rect box;      ///< of the view, with a pixel of background, unless the image ends
  cv::Mat mask;      ///< CV_8UC1, 0 or 255, of `box`
  int pixels = 0;    ///< of the mask
  DepthLayer layer;  ///< of the larger part of the mask
};

struct FoundObjects {
  std::vector<FoundObject> objects;
  cv::Mat instances;  ///< CV_8UC1, 1 + index into `objects`, 0 = none; of the view's size
};

struct FindOptions {
  int min_pixels = 100;  ///< of the frame; smaller parts of a class are no objects, where the
                         ///< result itself names none
  int rim = 4;           ///< px of the view, uncertainty of outlines: no separate surfaces
};

/// Those of the result as it is, then the surfaces.
FoundObjects found_objects(const Segmentation& segmentation, const View& view,
                           const FindOptions& options);

}  // namespace stillpoint::propagator_flow_depth
