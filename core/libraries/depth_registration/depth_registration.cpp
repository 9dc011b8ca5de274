#include "depth_registration/depth_registration.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace stillpoint::depth_registration {
namespace {

/// The first pixel whose centre does not lie before `edge`; pixels between two edges belong to one
/// of the neighbours only.
int first_from(double edge, int size) {
  return static_cast<int>(std::clamp(std::ceil(edge), 0.0, static_cast<double>(size)));
}

template <class Value>
void keep_nearest(cv::Mat& image, const cv::Rect& area, Value value) {
  for (int y = area.y; y < area.br().y; ++y) {
    auto* row = image.ptr<Value>(y);
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
  return depth.type() == CV_32FC1 ? registered<float>(depth, factor)
                                  : registered<std::uint16_t>(depth, factor);
}

template <class Value>
cv::Mat DepthRegistration::registered(const cv::Mat& depth, double factor) const {
  constexpr bool kWhole = std::is_integral_v<Value>;
  cv::Mat result(color_.height, color_.width, depth.type(), cv::Scalar(0));
  for (int y = 0; y < depth.rows; ++y)
    for (int x = 0; x < depth.cols; ++x) {
      const double z = depth.at<Value>(y, x) / factor;
      if (!(z > 0.0)) continue;  // NaN is no measurement, either
      const Eigen::Vector3d first = in_color(x - 0.5, y - 0.5, z);
      const Eigen::Vector3d last = in_color(x + 0.5, y + 0.5, z);
      if (first.z() <= 0 || last.z() <= 0) continue;
      const double middle = factor * (first.z() + last.z()) / 2;
      const double value = kWhole ? std::round(middle) : middle;
      if ((kWhole && value < 1) || value > std::numeric_limits<Value>::max()) continue;
      const cv::Point begin(first_from(first.x(), color_.width),
                            first_from(first.y(), color_.height));
      const cv::Point end(first_from(last.x(), color_.width), first_from(last.y(), color_.height));
      keep_nearest(result, cv::Rect(begin, end), static_cast<Value>(value));
    }
  return result;
}

}  // namespace stillpoint::depth_registration
