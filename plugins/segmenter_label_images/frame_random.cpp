#include "segmenter_label_images/frame_random.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace stillpoint::segmenter_label_images {
namespace {

// Finaliser of SplitMix64: close numbers give unrelated streams.
std::uint64_t mixed(std::uint64_t value) {
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9u;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebu;
  return value ^ (value >> 31);
}

}  // namespace

cv::RNG frame_random(std::uint64_t seed, Purpose purpose, std::uint32_t period) {
  return cv::RNG(mixed(mixed(seed + static_cast<std::uint32_t>(purpose)) + period));
}

cv::Mat random_blob(cv::Size size, cv::RNG& random) {
  const cv::Point centre(random.uniform(0, size.width), random.uniform(0, size.height));
  const int unit = std::max(size.height, 16);
  const cv::Size half_axes(random.uniform(unit / 16, unit / 4),
                           random.uniform(unit / 16, unit / 4));
  cv::Mat blob(size, CV_8UC1, cv::Scalar(0));
  cv::ellipse(blob, centre, half_axes, random.uniform(0.0, 180.0), 0, 360, 255, cv::FILLED);
  return blob;
}

}  // namespace stillpoint::segmenter_label_images
