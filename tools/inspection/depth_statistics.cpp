#include "inspection/depth_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace stillpoint::inspection {

void DepthStatistics::add(const cv::Mat& raw) {
  const std::uint64_t zeros_before = counts_[0];
  for (int y = 0; y < raw.rows; ++y) {
    const auto* row = raw.ptr<std::uint16_t>(y);
    for (int x = 0; x < raw.cols; ++x) ++counts_[row[x]];
  }
  pixels_ += raw.total();
  ++images_;
  if (counts_[0] - zeros_before == raw.total()) ++empty_images_;
}

double DepthStatistics::valid_share() const {
  return pixels_ == 0 ? 0.0 : 1.0 - static_cast<double>(counts_[0]) / static_cast<double>(pixels_);
}

int DepthStatistics::quantile(double share) const {
  const double wanted = share * static_cast<double>(pixels_ - counts_[0]);
  std::uint64_t sum = 0;
  for (int value = 1; value < 65536; ++value) {
    sum += counts_[value];
    if (sum > 0 && static_cast<double>(sum) >= wanted) return value;
  }
  return 0;
}

double DepthStatistics::share_between(double from, double to, double depth_factor) const {
  const auto index = [&](double metres) {
    return static_cast<std::ptrdiff_t>(std::clamp(std::ceil(metres * depth_factor), 1.0, 65536.0));
  };
  const auto sum =
      std::accumulate(counts_.begin() + index(from), counts_.begin() + index(to), std::uint64_t{0});
  return pixels_ == counts_[0]
             ? 0.0
             : static_cast<double>(sum) / static_cast<double>(pixels_ - counts_[0]);
}

}  // namespace stillpoint::inspection
