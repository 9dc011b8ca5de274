#include "propagator_flow_depth/mask_fit.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace stillpoint::propagator_flow_depth {
namespace {

constexpr float kDepthWeight = 1.2f;  // mask: 1; depth may remove its interior as well
constexpr int kSparse = 4;            // px between the depths that are averaged
constexpr int kSurroundings = 4;      // margins to either side, over which depths are averaged

cv::Size sparse(cv::Size size) {
  return {(size.width + kSparse - 1) / kSparse, (size.height + kSparse - 1) / kSparse};
}

/// Mean of `depth` around each pixel over those in `mask` (0 or 255); 0 where there are none.
cv::Mat local_depth(const cv::Mat& depth, const cv::Mat& mask, cv::Size window) {
  cv::Mat weights, sum, count;
  mask.convertTo(weights, CV_32F, 1.0 / 255);
  cv::boxFilter(depth.mul(weights), sum, CV_32F, window, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::boxFilter(weights, count, CV_32F, window, {-1, -1}, false, cv::BORDER_CONSTANT);
  cv::Mat mean = sum / cv::max(count, 1.0f);
  mean.setTo(0, count < 0.5f);
  return mean;
}

/// > 0: depth is evidence for the object.
float depth_vote(float depth, float object, float surroundings, const DepthLayer& layer,
                 float tolerance) {
  if (!(depth > 0) || !layer.known()) return 0.0f;
  if (depth < layer.near - tolerance || depth > layer.far + tolerance) return -kDepthWeight;
  if (object == 0 || surroundings == 0) return 0.0f;
  const float difference = std::abs(depth - surroundings) - std::abs(depth - object);
  return kDepthWeight * std::clamp(difference / tolerance, -1.0f, 1.0f);
}

}  // namespace

cv::Mat fit_to_depth(const cv::Mat& predicted, const cv::Mat& depth, const DepthLayer& layer,
                     const MaskFitOptions& options) {
  cv::Mat sparse_depth, sparse_mask, in_layer;
  cv::resize(depth, sparse_depth, sparse(depth.size()), 0, 0, cv::INTER_NEAREST);
  cv::resize(predicted, sparse_mask, sparse(depth.size()), 0, 0, cv::INTER_NEAREST);
  cv::inRange(sparse_depth, layer.near, layer.far, in_layer);
  const int reach = kSurroundings * options.margin / kSparse;
  const cv::Size window(2 * reach + 1, 2 * reach + 1);
  const cv::Mat object = local_depth(sparse_depth, sparse_mask & in_layer, window);
  const cv::Mat surroundings = local_depth(sparse_depth, ~sparse_mask & (sparse_depth > 0), window);
  cv::Mat nearness;  // 0: outside by the margin or more, 255: inside
  cv::blur(predicted, nearness, cv::Size(2, 2) * options.margin + cv::Size(1, 1), {-1, -1},
           cv::BORDER_REPLICATE);

  cv::Mat fitted(predicted.size(), CV_8UC1, cv::Scalar(0));
  for (int y = 0; y < fitted.rows; ++y) {
    const auto* near = nearness.ptr<unsigned char>(y);
    const auto* z = depth.ptr<float>(y);
    const auto* object_z = object.ptr<float>(y / kSparse);
    const auto* other_z = surroundings.ptr<float>(y / kSparse);
    auto* out = fitted.ptr<unsigned char>(y);
    for (int x = 0; x < fitted.cols; ++x) {
      if (near[x] == 0) continue;
      const float tolerance =
          static_cast<float>(options.tolerance) * std::max(0.5f, z[x] * z[x] / 4);
      const float mask_vote = static_cast<float>(near[x]) / 127.5f - 1.0f;
      const float vote =
          depth_vote(z[x], object_z[x / kSparse], other_z[x / kSparse], layer, tolerance);
      out[x] = mask_vote + vote > 0 ? 255 : 0;
    }
  }
  return fitted;
}

}  // namespace stillpoint::propagator_flow_depth
