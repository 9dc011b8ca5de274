#include "propagator_flow_depth/mask_warp.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace stillpoint {
namespace {

constexpr int kCell = 8;               // px between the nodes where motion is computed
constexpr float kReach = 12.0f;        // px around a track that move with it
constexpr float kMedianWeight = 0.1f;  // of the median motion against a track right there

float median(std::vector<float>& values) {
  if (values.empty()) return 0.0f;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

/// From a position in the current view back to the reference: the motion of the tracks around it.
cv::Point2f way_back(cv::Point2f position, std::span<const Track> tracks,
                     cv::Point2f median_shift) {
  cv::Point2f sum = -kMedianWeight * median_shift;
  float weights = kMedianWeight;
  for (const Track& track : tracks) {
    if (track.lost) continue;
    const cv::Point2f offset = (track.current - position) / kReach;
    const float falloff = 1.0f / (1.0f + offset.dot(offset));
    const float weight = falloff * falloff;
    sum += weight * (track.reference - track.current);
    weights += weight;
  }
  return sum / weights;
}

}  // namespace

ObjectMotion median_motion(std::span<const Track> tracks) {
  std::vector<float> x, y, z;
  for (const Track& track : tracks) {
    if (track.lost) continue;
    x.push_back(track.current.x - track.reference.x);
    y.push_back(track.current.y - track.reference.y);
    if (track.reference_depth > 0 && track.current_depth > 0)
      z.push_back(track.current_depth - track.reference_depth);
  }
  return {{median(x), median(y)}, median(z)};
}

cv::Mat warp_mask(const cv::Mat& reference, std::span<const Track> tracks, cv::Rect region) {
  const cv::Point2f shift = median_motion(tracks).shift;
  cv::Mat nodes(region.height / kCell + 2, region.width / kCell + 2, CV_32FC2);
  for (int row = 0; row < nodes.rows; ++row)
    for (int column = 0; column < nodes.cols; ++column) {
      const cv::Point node = region.tl() + kCell * cv::Point(column, row);
      nodes.at<cv::Point2f>(row, column) = way_back(node, tracks, shift);
    }
  cv::Mat source(region.size(), CV_32FC2);
  for (int y = 0; y < region.height; ++y) {
    const float v = static_cast<float>(y) / kCell;
    const int row = static_cast<int>(v);
    const float fy = v - static_cast<float>(row);
    const auto* upper = nodes.ptr<cv::Point2f>(row);
    const auto* lower = nodes.ptr<cv::Point2f>(row + 1);
    auto* out = source.ptr<cv::Point2f>(y);
    for (int x = 0; x < region.width; ++x) {
      const float u = static_cast<float>(x) / kCell;
      const int column = static_cast<int>(u);
      const float fx = u - static_cast<float>(column);
      const cv::Point2f left = upper[column] + fy * (lower[column] - upper[column]);
      const cv::Point2f right = upper[column + 1] + fy * (lower[column + 1] - upper[column + 1]);
      out[x] = cv::Point2f(region.tl() + cv::Point(x, y)) + left + fx * (right - left);
    }
  }
  cv::Mat warped;
  cv::remap(reference, warped, source, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  return warped > 127;
}

}  // namespace stillpoint
