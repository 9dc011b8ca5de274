// Layers before and behind what a recording shows.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "people/layer.hpp"

namespace stillpoint::people {

/// How far the scene is where the sensor measured nothing, too: a guess from around it, and without
/// the specks at edges. CV_32F, metres; 0: nothing measured anywhere.
cv::Mat filled_depth(const cv::Mat& depth);

/// Which layer is visible in which pixel.
struct Composition {
  std::vector<cv::Mat> shares;  ///< CV_32F per layer: its share in the colour of each pixel
  cv::Mat owner;                ///< CV_8U: number of the layer from 1; 0: the scene
  cv::Mat z;                    ///< CV_32F, m, of the owner; 0: the scene
};

/// `scene`: filled_depth() of the same view.
Composition compose(const std::vector<Layer>& layers, const cv::Mat& scene);

/// `bgr`: CV_8UC3.
void paint(const std::vector<Layer>& layers, const Composition& composition, cv::Mat& bgr);

}  // namespace stillpoint::people
