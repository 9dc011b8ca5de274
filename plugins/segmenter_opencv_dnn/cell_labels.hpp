// Class scores per cell become labels per pixel.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "segmenter_opencv_dnn/cell_grid.hpp"
#include "stillpoint/contracts/segmentation.hpp"

namespace stillpoint::segmenter_opencv_dnn {

/// Scores that speak for a label. A label may have several.
struct ScorePlane {
  cv::Mat scores;  ///< CV_32FC1, one per cell
  int label = 0;
};

/// CV_8UC1 of the image's size: the label of the plane whose interpolated score is highest, of
/// equal ones the first.
cv::Mat label_pixels(const std::vector<ScorePlane>& planes, const CellGrid& grid);

/// Sets the objects' scores to the mean over their pixels of the nearest cell's probability of
/// their class; `probabilities` by class id, CV_32FC1 per cell.
void score_objects(Segmentation& segmentation, const std::vector<cv::Mat>& probabilities,
                   const CellGrid& grid);

}  // namespace stillpoint::segmenter_opencv_dnn
