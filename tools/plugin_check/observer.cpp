#include "plugin_check/observer.hpp"

#include <algorithm>

namespace stillpoint::plugin_check {

std::uint32_t checksum_of(const cv::Mat& image) {
  boost::crc_32_type checksum;
  for (int y = 0; y < image.rows; ++y)
    checksum.process_bytes(image.ptr(y), static_cast<std::size_t>(image.cols) * image.elemSize());
  return checksum.checksum();
}

void Observer::saw(const cv::Mat& image) {
  kept_.push_back({image, checksum_of(image)});
  saw(kept_.back().checksum);
  saw(image.cols);
}

void Observer::require_unchanged() const {
  for (const Kept& kept : kept_)
    if (checksum_of(kept.image) != kept.checksum)
      throw Failure({"an image that it had given changed during a later call",
                     "other threads still read it: weights and labels of two frames would mix",
                     "give images of their own, or clone() what you keep working on"});
}

std::vector<CallTime> Observer::times() const {
  std::vector<CallTime> times;
  for (const auto& [function, all] : milliseconds_) {
    std::vector<double> sorted = all;
    std::ranges::sort(sorted);
    times.push_back(
        {function, static_cast<int>(sorted.size()), sorted[sorted.size() / 2], sorted.back()});
  }
  return times;
}

}  // namespace stillpoint::plugin_check
