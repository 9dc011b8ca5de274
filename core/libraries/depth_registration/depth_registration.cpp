#include "importing/depth_registration.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stillpoint::importing {
namespace {

/// The first pixel whose centre does not lie before `edge`; pixels between two edges belong to one
/// of the neighbours only.
int first_from(double edge, int size) {
  return static_cast<int>(std::clamp(std::ceil(edge), 0.0, static_cast<double>(size)));
}

void keep_nearest(cv::Mat& image, const cv::Rect& area, std::uint16_t value) {
  for (int y = area.y; y < area.br().y; ++y) {
    auto* row = image.ptr<std::uint16_t>(y);
    for (int x = area.x; x < area.br().x; ++x)
      if (row[x] == 0 || value < row[x]) row[x] = value;
  }
}

}  // namespace

Eigen::Vector3d DepthRegistration::in_color(double u, double v, double z) const {
  const Eigen::Vector3d point = color_from_depth_ * depth_.unproject(u, v, z);
  const Eigen::Vector2d pixel = color_.project(point);
  return {pixel.x(), pixel.y(), point.z()};
}

cv::Mat DepthRegistration::register_image(const cv::Mat& depth, double factor) const {
  constexpr double kLargest = std::numeric_limits<std::uint16_t>::max();
  cv::Mat result(color_.height, color_.width, CV_16UC1, cv::Scalar(0));
  for (int y = 0; y < depth.rows; ++y)
    for (int x = 0; x < depth.cols; ++x) {
      const double z = depth.at<std::uint16_t>(y, x) / factor;
      if (z == 0.0) continue;
      const Eigen::Vector3d first = in_color(x - 0.5, y - 0.5, z);
      const Eigen::Vector3d last = in_color(x + 0.5, y + 0.5, z);
      const double value = std::round(factor * (first.z() + last.z()) / 2);
      if (first.z() <= 0 || last.z() <= 0 || value < 1 || value > kLargest) continue;
      const cv::Point begin(first_from(first.x(), color_.width),
                            first_from(first.y(), color_.height));
      const cv::Point end(first_from(last.x(), color_.width), first_from(last.y(), color_.height));
      keep_nearest(result, cv::Rect(begin, end), static_cast<std::uint16_t>(value));
    }
  return result;
}

}  // namespace stillpoint::importing
