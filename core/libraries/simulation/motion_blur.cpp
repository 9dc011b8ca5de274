#include "simulation/motion_blur.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::simulation {
namespace {

cv::Vec3f bilinear(const cv::Mat& image, float x, float y) {
  const float inner_x = std::clamp(x, 0.0F, static_cast<float>(image.cols - 1) - 0.001F);
  const float inner_y = std::clamp(y, 0.0F, static_cast<float>(image.rows - 1) - 0.001F);
  const int column = static_cast<int>(inner_x);
  const int row = static_cast<int>(inner_y);
  const float right = inner_x - static_cast<float>(column);
  const float down = inner_y - static_cast<float>(row);
  const auto* upper = image.ptr<cv::Vec3f>(row) + column;
  const auto* lower = image.ptr<cv::Vec3f>(row + 1) + column;
  return (1 - down) * ((1 - right) * upper[0] + right * upper[1]) +
         down * ((1 - right) * lower[0] + right * lower[1]);
}

}  // namespace

float MotionRange::fastest() const { return low.cwiseAbs().cwiseMax(high.cwiseAbs()).norm(); }

MotionMap MotionMap::widened() const {
  constexpr int kColumns = 1;  // to either side
  constexpr int kRows = 2;
  MotionMap wide = *this;
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < columns_; ++x)
      for (int i = std::max(0, x - kColumns); i <= std::min(columns_ - 1, x + kColumns); ++i)
        wide.at(x, y).include(at(i, y));
  MotionMap result = wide;
  for (int y = 0; y < rows_; ++y)
    for (int i = std::max(0, y - kRows); i <= std::min(rows_ - 1, y + kRows); ++i)
      for (int x = 0; x < columns_; ++x) result.at(x, y).include(wide.at(x, i));
  return result;
}

cv::Vec3f mean_along(const cv::Mat& image, const cv::Point& pixel, const Eigen::Vector2f& motion) {
  constexpr float kMostSamples = 24;
  // One sample per pixel of motion: the image is as smooth as a pixel is wide.
  const float count = std::clamp(std::ceil(motion.norm()), 2.0F, kMostSamples);
  cv::Vec3f sum;
  for (float i = 0.5F; i < count; ++i) {
    const Eigen::Vector2f shift = (i / count - 0.5F) * motion;
    sum += bilinear(image, static_cast<float>(pixel.x) + shift.x(),
                    static_cast<float>(pixel.y) + shift.y());
  }
  return sum * (1 / count);
}

}  // namespace stillpoint::simulation
