#include "simulation/pyramid.hpp"

#include <algorithm>
#include <bit>
#include <opencv2/imgproc.hpp>

namespace stillpoint::simulation {
namespace {

int power_of_two(int size) { return static_cast<int>(std::bit_ceil(static_cast<unsigned>(size))); }

int octaves_of(const cv::Size& finest) {
  return std::bit_width(static_cast<unsigned>(std::max(finest.width, finest.height)));
}

/// As far between two octaves as half an octave is: bilinear look-ups add to the width of texels.
cv::Mat half_octave_coarser(const cv::Mat& image) {
  const cv::Matx13f kernel(1.0F / 8, 6.0F / 8, 1.0F / 8);
  cv::Mat padded;
  cv::copyMakeBorder(image, padded, 1, 1, 1, 1, cv::BORDER_WRAP);
  cv::Mat smooth;
  cv::sepFilter2D(padded, smooth, -1, kernel, kernel);
  return smooth(cv::Rect(1, 1, image.cols, image.rows));
}

std::vector<std::uint32_t> packed(const cv::Mat& image) {
  std::vector<std::uint32_t> texels(image.total());
  std::transform(image.begin<cv::Vec3b>(), image.end<cv::Vec3b>(), texels.begin(),
                 [](const cv::Vec3b& c) {
                   return c[0] | std::uint32_t{c[1]} << 8 | std::uint32_t{c[2]} << 16;
                 });
  return texels;
}

}  // namespace

Pyramid::Pyramid(const cv::Mat& bgr, Eigen::Vector2f size)
    : size_(size),
      finest_(power_of_two(bgr.cols), power_of_two(bgr.rows)),
      octave_count_(octaves_of(finest_)),
      bgr_(bgr) {
  CV_Assert(octave_count_ <= kMaxOctaves);
}

const PyramidLevel& Pyramid::make_level(int number) const {
  const std::scoped_lock lock(mutex_);
  const auto place = static_cast<std::size_t>(number);
  if (!levels_[place]) {
    const cv::Mat& image = octave(number / 2);
    const Eigen::Vector2f texels(static_cast<float>(image.cols), static_cast<float>(image.rows));
    levels_[place] = std::make_unique<PyramidLevel>(
        PyramidLevel{image.cols, image.rows, 256 * texels.cwiseQuotient(size_),
                     packed(number % 2 == 0 ? image : half_octave_coarser(image))});
    made_[place].store(levels_[place].get(), std::memory_order_release);
  }
  return *levels_[place];
}

/// With the mutex held.
const cv::Mat& Pyramid::octave(int number) const {
  while (static_cast<int>(octaves_.size()) <= number) {
    cv::Mat next;
    if (octaves_.empty()) {
      cv::resize(bgr_, next, finest_, 0, 0, cv::INTER_CUBIC);
      bgr_.release();
    } else {
      const cv::Mat& last = octaves_.back();
      const cv::Size half(std::max(1, last.cols / 2), std::max(1, last.rows / 2));
      cv::resize(last, next, half, 0, 0, cv::INTER_AREA);
    }
    octaves_.push_back(next);
  }
  return octaves_[static_cast<std::size_t>(number)];
}

}  // namespace stillpoint::simulation
