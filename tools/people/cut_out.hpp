// Somebody cut out of a photograph.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

namespace stillpoint::people {

/// As flat as a stage set but for some relief. Colours go on beyond the outline, so that nothing of
/// the photograph's background shines through where the outline is softened.
struct CutOut {
  cv::Mat bgr;            ///< CV_32FC3, 0…255
  cv::Mat alpha;          ///< CV_32FC1, 0 outside … 1
  cv::Mat relief;         ///< CV_32FC1, heights of the person towards the camera
  cv::Scalar light;       ///< mean colour of the photograph around the person
  double highlights = 0;  ///< the brightest tenth of the person is brighter, 0…255
};

/// `photo`: CV_8UC3; `mask`: CV_8UC1, 255 on the person, whose box is cut out. Small photographs
/// are enlarged and get the grain that they are too coarse to show, drawn from `seed`.
CutOut cut_out(const cv::Mat& photo, const cv::Mat& mask, int seed);

/// The cut-out in full, half, quarter, … size, so that small people do not shimmer.
std::vector<CutOut> levels_of(CutOut cut);

}  // namespace stillpoint::people
