#include "propagator_flow_depth/mask_warp.hpp"

#include <opencv2/imgproc.hpp>
#include <vector>

#include "stillpoint/support/median.hpp"

namespace stillpoint::propagator_flow_depth {
namespace {

constexpr int kCell = 8;    // px between the nodes where motion is computed
constexpr int kSample = 2;  // px between the samples of the mask
const cv::Point2f kSampleCentre =
    cv::Point2f(kSample - 1, kSample - 1) / 2;  // as cv::resize has it
constexpr float kMedianWeight = 0.1f;           // of the median motion against a track right there

/// Motion from a position in the current view back to the reference, interpolated from the tracks.
cv::Point2f backward_motion(cv::Point2f position, std::span<const Track> tracks,
                            cv::Point2f median_shift, float reach) {
  cv::Point2f sum = -kMedianWeight * median_shift;
  float weights = kMedianWeight;
  for (const Track& track : tracks) {
    if (track.lost) continue;
    const cv::Point2f offset = (track.current - position) / reach;
    const float falloff = 1.0f / (1.0f + offset.dot(offset));
    const float weight = falloff * falloff;
    sum += weight * (track.reference - track.current);
    weights += weight;
  }
  return sum / weights;
}

/// Bilinear between the four nodes around a pixel of the region.
cv::Point2f between(const cv::Mat& nodes, int x, int y) {
  const auto* upper = nodes.ptr<cv::Point2f>(y / kCell) + x / kCell;
  const auto* lower = nodes.ptr<cv::Point2f>(y / kCell + 1) + x / kCell;
  const float fx = static_cast<float>(x % kCell) / kCell;
  const float fy = static_cast<float>(y % kCell) / kCell;
  const cv::Point2f left = upper[0] + fy * (lower[0] - upper[0]);
  const cv::Point2f right = upper[1] + fy * (lower[1] - upper[1]);
  return left + fx * (right - left);
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

cv::Mat warp_mask(const cv::Mat& reference, cv::Rect box, std::span<const Track> tracks,
                  cv::Rect region, float reach) {
  const cv::Point2f shift = median_motion(tracks).shift;
  cv::Mat nodes(region.height / kCell + 2, region.width / kCell + 2, CV_32FC2);
  for (int row = 0; row < nodes.rows; ++row)
    for (int column = 0; column < nodes.cols; ++column) {
      const cv::Point node = region.tl() + kCell * cv::Point(column, row);
      const cv::Point2f source = cv::Point2f(node) + backward_motion(node, tracks, shift, reach);
      nodes.at<cv::Point2f>(row, column) = source - cv::Point2f(box.tl());
    }
  // A sample every kSample px is enough for an outline that depth will correct.
  cv::Mat source((region.height + kSample - 1) / kSample, (region.width + kSample - 1) / kSample,
                 CV_32FC2);
  for (int y = 0; y < source.rows; ++y)
    for (int x = 0; x < source.cols; ++x)
      source.at<cv::Point2f>(y, x) = between(nodes, kSample * x, kSample * y) + kSampleCentre;
  cv::Mat samples, warped;
  cv::remap(reference, samples, source, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
  cv::resize(samples, warped, samples.size() * kSample, 0, 0, cv::INTER_LINEAR);
  return warped(cv::Rect({}, region.size())) > 127;
}

}  // namespace stillpoint::propagator_flow_depth
