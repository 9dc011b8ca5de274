#include "segmenter_opencv_dnn/cell_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace stillpoint::segmenter_opencv_dnn {
namespace {

/// Interpolates a quantity that is given per cell.
template <class CellValue>
double interpolated(const CellPosition& position, CellValue value) {
  return (1.0 - position.share) * value(position.cell) + position.share * value(position.cell + 1);
}

// A linear function of the image, taken where the cells are, comes back exactly.
TEST(CellGrid, CornersLieOnEverySixteenthInputPixel) {
  for (const int pixels : {640, 513, 100}) {
    const CellGrid grid(CellAlignment::kCorners, {33, 25}, {513, 385}, {pixels, 480});
    const auto image_x = [&](int cell) { return (16 * cell + 0.5) * pixels / 513 - 0.5; };
    for (int x = 0; x < pixels; ++x)
      EXPECT_NEAR(interpolated(grid.columns[static_cast<std::size_t>(x)], image_x),
                  std::clamp<double>(x, image_x(0), image_x(32)), 1e-4);
  }
}

TEST(CellGrid, CentresTileTheInput) {
  const CellGrid grid(CellAlignment::kCentres, {256, 144}, {256, 144}, {640, 480});
  const auto image_y = [&](int cell) { return (cell + 0.5) * 480 / 144 - 0.5; };
  for (int y = 0; y < 480; ++y)
    EXPECT_NEAR(interpolated(grid.rows[static_cast<std::size_t>(y)], image_y),
                std::clamp<double>(y, image_y(0), image_y(143)), 1e-4);
}

TEST(CellGrid, SameSizeIsTheIdentity) {
  for (const CellAlignment alignment : {CellAlignment::kCentres, CellAlignment::kCorners}) {
    const CellGrid grid(alignment, {64, 48}, {64, 48}, {64, 48});
    for (int x = 0; x < 64; ++x)
      EXPECT_NEAR(interpolated(grid.columns[static_cast<std::size_t>(x)], [](int c) { return c; }),
                  x, 1e-5);
  }
}

TEST(CellGrid, OneCellCoversEverything) {
  const CellGrid grid(CellAlignment::kCorners, {1, 1}, {16, 16}, {5, 1});
  ASSERT_EQ(grid.columns.size(), 5u);
  for (const CellPosition& position : grid.columns) {
    EXPECT_EQ(position.cell, 0);
    EXPECT_EQ(position.share, 0.0f);
  }
}

}  // namespace
}  // namespace stillpoint::segmenter_opencv_dnn
