// How the cells of a network's output lie on the image.
#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

namespace stillpoint::segmenter_opencv_dnn {

enum class CellAlignment {
  kCentres,  ///< the cells tile the input, as those of a network that ends at its input's size
  kCorners,  ///< first and last cell lie on the first and last pixel of the input (align_corners)
};

/// A pixel between two cells: `cell` and the next one, which has this share.
struct CellPosition {
  int cell = 0;
  float share = 0.0f;
};

/// Where the pixels of an image lie on the cells, bilinearly. All of it is exact: pixel centres of
/// the image, stretched to the input, between cell centres.
struct CellGrid {
  CellGrid() = default;
  CellGrid(CellAlignment alignment, cv::Size cells, cv::Size input, cv::Size image);

  cv::Size cells;
  cv::Size image;
  std::vector<CellPosition> columns;  ///< one per column of the image
  std::vector<CellPosition> rows;     ///< one per row of the image
};

}  // namespace stillpoint::segmenter_opencv_dnn
