#include "segmenter_opencv_dnn/cell_grid.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::segmenter_opencv_dnn {
namespace {

std::vector<CellPosition> positions(CellAlignment alignment, int cells, int input, int pixels) {
  std::vector<CellPosition> result(static_cast<std::size_t>(pixels));
  if (cells == 1) return result;
  const double input_per_pixel = static_cast<double>(input) / pixels;
  const double stride = alignment == CellAlignment::kCorners
                            ? static_cast<double>(input - 1) / (cells - 1)
                            : static_cast<double>(input) / cells;  // input pixels per cell
  for (int i = 0; i < pixels; ++i) {
    const double edge = (i + 0.5) * input_per_pixel;
    const double cell = alignment == CellAlignment::kCorners ? (edge - 0.5) / stride  //
                                                             : edge / stride - 0.5;
    const double inside = std::clamp(cell, 0.0, cells - 1.0);
    const int first = std::min(static_cast<int>(inside), cells - 2);
    result[static_cast<std::size_t>(i)] = {first, static_cast<float>(inside - first)};
  }
  return result;
}

}  // namespace

CellGrid::CellGrid(CellAlignment alignment, cv::Size cells_, cv::Size input, cv::Size image_)
    : cells(cells_),
      image(image_),
      columns(positions(alignment, cells_.width, input.width, image_.width)),
      rows(positions(alignment, cells_.height, input.height, image_.height)) {}

}  // namespace stillpoint::segmenter_opencv_dnn
