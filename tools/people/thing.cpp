#include "people/thing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace stillpoint::people {
namespace {

using Eigen::Vector3d;

struct Hit {
  double z = 0;  // along the ray, whose own z is 1; 0: none
  int axis = 0;  // of the side
};

/// Where a ray enters the box from -half to half.
Hit hit_box(const Vector3d& origin, const Vector3d& ray, const Vector3d& half) {
  Hit hit{.z = -std::numeric_limits<double>::infinity()};
  double leaves = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 3; ++i) {
    if (std::abs(ray[i]) < 1e-9) {
      if (std::abs(origin[i]) > half[i]) return {};
      continue;
    }
    const double a = (-half[i] - origin[i]) / ray[i];
    const double b = (half[i] - origin[i]) / ray[i];
    if (std::min(a, b) > hit.z) hit = {std::min(a, b), i};
    leaves = std::min(leaves, std::max(a, b));
  }
  return hit.z > 0 && hit.z < leaves ? hit : Hit{};
}

/// The picture covers the side.
cv::Vec3f colour_at(const cv::Mat& side, const Vector3d& place, const Vector3d& half, int axis) {
  const int across = axis == 0 ? 1 : 0;
  const int up = axis == 2 ? 1 : 2;
  const double u = 0.5 + 0.5 * place[across] / half[across];
  const double v = 0.5 - 0.5 * place[up] / half[up];
  return side.at<cv::Vec3f>(cvFloor(std::clamp(v, 0.0, 0.9999) * side.rows),
                            cvFloor(std::clamp(u, 0.0, 0.9999) * side.cols));
}

}  // namespace

Thing::Thing(ThingPlan plan, std::array<cv::Mat, 3> sides, double lower)
    : plan_(std::move(plan)), lower_(lower) {
  for (std::size_t i = 0; i < sides.size(); ++i) cv::Mat(sides[i]).convertTo(sides_[i], CV_32F);
}

Layer Thing::seen_from(const Pose& level_from_camera, const Rays& rays, double time) const {
  const Vector3d half = 0.5 * Vector3d(plan_.size[0], plan_.size[1], plan_.size[2]);
  const Vector3d foot = at_time(plan_.path, 4, time);
  Pose level_from_box = Pose::Identity();
  level_from_box.linear() =
      Eigen::AngleAxisd(plan_.turn * std::numbers::pi / 180, Vector3d::UnitZ()).toRotationMatrix();
  level_from_box.translation() = foot + Vector3d(0, 0, half.z() - lower_);
  const Pose box_from_camera = level_from_box.inverse() * level_from_camera;
  Layer layer{.bgr = cv::Mat::zeros(rays.size(), CV_32FC3),
              .alpha = cv::Mat::zeros(rays.size(), CV_32F),
              .z = cv::Mat::zeros(rays.size(), CV_32F)};
  for (int y = 0; y < rays.size().height; ++y) {
    const cv::Vec2f* row = rays.row(y);
    for (int x = 0; x < rays.size().width; ++x) {
      const Vector3d ray = box_from_camera.linear() * Vector3d(row[x][0], row[x][1], 1);
      const Hit hit = hit_box(box_from_camera.translation(), ray, half);
      if (hit.z <= 0) continue;
      const Vector3d place = box_from_camera.translation() + hit.z * ray;
      layer.bgr.at<cv::Vec3f>(y, x) =
          colour_at(sides_[static_cast<std::size_t>(hit.axis)], place, half, hit.axis);
      layer.alpha.at<float>(y, x) = 1;
      layer.z.at<float>(y, x) = static_cast<float>(hit.z);
    }
  }
  layer.box = cv::boundingRect(layer.alpha > 0);
  // One ray per pixel: the outline is as soft as the rest of the recording.
  cv::blur(layer.alpha, layer.alpha, {3, 3});
  layer.alpha.setTo(0, layer.z == 0);
  return layer;
}

}  // namespace stillpoint::people
