// Masks of objects, and the weights of the pixels under them.
#pragma once

#include <opencv2/core/mat.hpp>

#include "stillpoint/contracts/segmentation.hpp"

namespace stillpoint::decision_objects {

/// Object `index` of a segmentation, cut out.
struct ObjectMask {
  cv::Rect box;  ///< px, of the mask in the image; empty when the object has no pixels
  cv::Mat mask;  ///< CV_8UC1, 255 on the object
};

/// The object's mask dilated by `margin` px: outlines are not exact, and a descriptor covers the
/// surroundings of its feature. `except` (CV_8UC1 of the image's size, or empty) is not 0 on pixels
/// that do not belong to the object.
ObjectMask mask_of(const Segmentation& segmentation, std::size_t index, int margin,
                   const cv::Mat& except = {});

/// Lowers the weights under the mask to at most `weight`. An empty image is full of 255.
void lower(cv::Mat& weights, cv::Size size, const ObjectMask& object, std::uint8_t weight);

}  // namespace stillpoint::decision_objects
