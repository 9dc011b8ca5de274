#include "people/smear.hpp"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace stillpoint::people {
namespace {

/// px by which the middle of the layer moves.
cv::Point2d way_of(const Layer& layer, const Pose& motion, const Rays& rays) {
  const cv::Point middle = (layer.box.tl() + layer.box.br()) / 2;
  const cv::Vec2f& ray = rays.at(middle.y, middle.x);
  const double z = cv::mean(layer.z(layer.box), layer.alpha(layer.box) > 0.5)[0];
  if (z <= 0) return {};
  const Eigen::Vector3d then = motion * (z * Eigen::Vector3d(ray[0], ray[1], 1));
  return {rays.focal() * (then.x() / then.z() - ray[0]),
          rays.focal() * (then.y() / then.z() - ray[1])};
}

/// A line of this length and direction, which sums to one.
cv::Mat line_kernel(cv::Point2d way) {
  constexpr double kLongest = 40;  // px
  const double length = std::min(kLongest, std::hypot(way.x, way.y));
  const int reach = static_cast<int>(length / 2) + 1;
  cv::Mat kernel = cv::Mat::zeros(2 * reach + 1, 2 * reach + 1, CV_32F);
  const int steps = 4 * reach + 1;
  const cv::Point2d unit = way * (1 / std::max(1e-9, std::hypot(way.x, way.y)));
  for (int i = 0; i < steps; ++i) {
    const cv::Point2d at = unit * (length * (static_cast<double>(i) / (steps - 1) - 0.5));
    kernel.at<float>(reach + cvRound(at.y), reach + cvRound(at.x)) +=
        1.0F / static_cast<float>(steps);
  }
  return kernel;
}

}  // namespace

void smear(Layer& layer, const Pose& camera_at_end_from_begin, const Rays& rays, double blur) {
  if (layer.box.empty()) return;
  const cv::Point2d way = way_of(layer, camera_at_end_from_begin, rays);
  const bool moves = std::hypot(way.x, way.y) > 1;
  if (!moves && blur <= 0) return;
  const cv::Mat kernel = line_kernel(way);
  const cv::Mat before = layer.alpha > 0;
  for (cv::Mat* image : {&layer.bgr, &layer.alpha}) {
    cv::Mat part = (*image)(layer.box);
    if (blur > 0) cv::GaussianBlur(part, part, {}, blur, blur, cv::BORDER_REPLICATE);
    if (moves) cv::filter2D(part, part, -1, kernel, {-1, -1}, 0, cv::BORDER_REPLICATE);
  }
  layer.alpha.setTo(0, layer.z <= 0);
}

}  // namespace stillpoint::people
