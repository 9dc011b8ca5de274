#include "propagator_flow_depth/depth_layer.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stillpoint::propagator_flow_depth {
namespace {

// An object's parts are less than 15 cm apart in depth, and people keep more distance to what is
// behind them: that is the size of people, not of the sensor or the room. A Kinect's noise is less
// up to 8 m.
constexpr float kBin = 0.05f;                 // metres
constexpr std::size_t kBins = 400;            // 20 m; the last one has all beyond
constexpr int kGap = 3;                       // bins
constexpr double kShare = 0.005;              // of the measurements that a bin needs to count
constexpr std::size_t kMinMeasurements = 20;  // measurements

using Histogram = std::array<int, kBins>;

std::size_t median_bin(const Histogram& histogram, int total) {
  int sum = 0;
  std::size_t bin = 0;
  while (bin + 1 < kBins && (sum += histogram[bin]) * 2 < total) ++bin;
  return bin;
}

/// The last bin in direction `step` that is connected to `start` without a gap.
std::size_t reach(const Histogram& histogram, std::size_t start, int step, double enough) {
  auto last = static_cast<int>(start);
  for (int bin = last + step; bin >= 0 && bin < static_cast<int>(kBins); bin += step) {
    if (std::abs(bin - last) > kGap) break;
    if (histogram[static_cast<std::size_t>(bin)] >= enough) last = bin;
  }
  return static_cast<std::size_t>(last);
}

}  // namespace

DepthLayer depth_layer(const cv::Mat& depth, const cv::Mat& mask) {
  Histogram histogram{};
  std::size_t total = 0;
  for (int y = 0; y < depth.rows; ++y) {
    const auto* z = depth.ptr<float>(y);
    const auto* m = mask.ptr<unsigned char>(y);
    for (int x = 0; x < depth.cols; ++x) {
      if (!m[x] || !(z[x] > 0)) continue;
      ++histogram[std::min(static_cast<std::size_t>(z[x] / kBin), kBins - 1)];
      ++total;
    }
  }
  if (total < kMinMeasurements) return {};
  const std::size_t middle = median_bin(histogram, static_cast<int>(total));
  const double enough = std::max(2.0, kShare * static_cast<double>(total));
  return {kBin * static_cast<float>(reach(histogram, middle, -1, enough)),
          kBin * (static_cast<float>(middle) + 0.5f),
          kBin * static_cast<float>(reach(histogram, middle, 1, enough) + 1)};
}

}  // namespace stillpoint::propagator_flow_depth
