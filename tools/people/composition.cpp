#include "people/composition.hpp"

#include <algorithm>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace stillpoint::people {
namespace {

constexpr float kOwns = 0.5F;     // share of a pixel from which it is a layer's
constexpr double kMargin = 0.02;  // m by which the scene may seem nearer without hiding somebody

/// Farthest layers first.
std::vector<std::size_t> far_to_near(const std::vector<Layer>& layers) {
  std::vector<double> distance;
  for (const Layer& layer : layers)
    distance.push_back(layer.box.empty() ? 0 : cv::mean(layer.z, layer.alpha > kOwns)[0]);
  std::vector<std::size_t> order(layers.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, [&](auto a, auto b) { return distance[a] > distance[b]; });
  return order;
}

}  // namespace

cv::Mat filled_depth(const cv::Mat& depth) {
  if (std::min(depth.rows, depth.cols) < 4) return depth.clone();
  cv::Mat calm, weight, coarse, coarse_weight;
  cv::medianBlur(depth, calm, 3);
  weight = cv::Mat(calm > 0) / 255;
  weight.convertTo(weight, CV_32F);
  cv::resize(calm, coarse, {}, 0.5, 0.5, cv::INTER_AREA);
  cv::resize(weight, coarse_weight, coarse.size(), 0, 0, cv::INTER_AREA);
  coarse /= cv::max(coarse_weight, 1e-6);
  coarse.setTo(0, coarse_weight < 1e-3);
  if (cv::countNonZero(coarse) == 0) return calm;
  cv::Mat guess;
  cv::resize(
      cv::countNonZero(coarse) < static_cast<int>(coarse.total()) ? filled_depth(coarse) : coarse,
      guess, calm.size(), 0, 0, cv::INTER_LINEAR);
  guess.copyTo(calm, calm == 0);
  return calm;
}

Composition compose(const std::vector<Layer>& layers, const cv::Mat& scene) {
  Composition result{.shares = std::vector<cv::Mat>(layers.size()),
                     .owner = cv::Mat::zeros(scene.size(), CV_8U),
                     .z = cv::Mat::zeros(scene.size(), CV_32F)};
  for (const std::size_t i : far_to_near(layers)) {
    const Layer& layer = layers[i];
    if (layer.box.empty()) continue;
    cv::Mat visible;
    cv::Mat((layer.z < scene + kMargin) | (scene == 0)).convertTo(visible, CV_32F, 1.0 / 255);
    visible.setTo(0, (result.z > 0) & (result.z < layer.z));
    cv::GaussianBlur(visible, visible, {3, 3}, 0);
    result.shares[i] = layer.alpha.mul(visible);
    const cv::Mat owned = result.shares[i] > kOwns;
    result.owner.setTo(static_cast<double>(i + 1), owned);
    layer.z.copyTo(result.z, owned);
  }
  return result;
}

void paint(const std::vector<Layer>& layers, const Composition& composition, cv::Mat& bgr) {
  cv::Mat mixed;
  bgr.convertTo(mixed, CV_32F);
  for (const std::size_t i : far_to_near(layers)) {
    if (composition.shares[i].empty()) continue;
    const cv::Rect& box = layers[i].box;
    cv::Mat share, part = mixed(box);
    cv::merge(std::vector<cv::Mat>(3, composition.shares[i](box)), share);
    cv::Mat change = share.mul(layers[i].bgr(box) - part);
    part += change;
  }
  mixed.convertTo(bgr, CV_8U);
}

}  // namespace stillpoint::people
