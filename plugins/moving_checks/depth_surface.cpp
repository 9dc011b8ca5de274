#include "moving_checks/depth_surface.hpp"

#include <algorithm>
#include <cmath>

#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::moving_checks {
namespace {

constexpr double kNoiseMultiple = 3;  // greatest second difference by noise alone

// px of 640 x 480 per px of the radius, for a pixel without depth: beside a near surface the shadow
// of the sensor's projector leaves a hole of that width.
constexpr int kHoleReach = 4;

// 0 where nothing is measured.
double inverse_depth(const cv::Mat& depth, int x, int y) {
  if (x < 0 || y < 0 || x >= depth.cols || y >= depth.rows) return 0;
  const float z = depth.at<float>(y, x);
  return z > 0 && std::isfinite(z) ? 1.0 / z : 0;
}

// The mean of what is measured on a ring, for pixels without depth of their own.
double mean_around(const cv::Mat& depth, const cv::Point& centre, int radius) {
  double sum = 0;
  int count = 0;
  for (int dy = -1; dy <= 1; ++dy)
    for (int dx = -1; dx <= 1; ++dx) {
      const double value = inverse_depth(depth, centre.x + dx * radius, centre.y + dy * radius);
      sum += value;
      count += value > 0;
    }
  return count > 0 ? sum / count : 0;
}

// Planes are linear in inverse depth, however steep: a discontinuity shows in the second
// difference. With one side only, the first difference is tested instead.
bool is_discontinuous(double a, double middle, double b, double step) {
  if (a > 0 && b > 0) return std::abs(a + b - 2 * middle) > step;
  const double side = a > 0 ? a : b;
  return side > 0 && std::abs(side - middle) > step;
}

}  // namespace

void SurfaceOptions::visit(OptionVisitor& v) {
  v("edge_radius", edge_radius,
    {.min = 1,
     .max = 50,
     .unit = "px",
     .help = "points this near to a depth edge are never called moving"});
  v("edge_jump", edge_jump,
    {.min = 0, .unit = "m", .help = "a larger deviation from a plane is a depth discontinuity"});
}

Surface surface_at(const cv::Mat& depth, const cv::Point2f& pixel, double noise,
                   const SurfaceOptions& options) {
  const cv::Point centre(cvRound(pixel.x), cvRound(pixel.y));
  double middle = inverse_depth(depth, centre.x, centre.y);
  int outer = options.edge_radius;
  const bool hole = middle == 0;
  if (hole) {
    outer = std::max(1, cvRound(outer * kHoleReach * pixel_scale(depth.size())));
    middle = mean_around(depth, centre, outer);
  }
  if (middle == 0) return {Surface::Kind::kNone, 0};
  const double step = options.edge_jump * middle * middle + kNoiseMultiple * noise;
  for (const int radius : {outer, (outer + 1) / 2}) {
    for (const cv::Point& side : {cv::Point(1, 0), {0, 1}, {1, 1}, {1, -1}}) {
      const double a = inverse_depth(depth, centre.x + radius * side.x, centre.y + radius * side.y);
      const double b = inverse_depth(depth, centre.x - radius * side.x, centre.y - radius * side.y);
      const bool edge =
          hole ? is_discontinuous(a, middle, 0, step) || is_discontinuous(0, middle, b, step)
               : is_discontinuous(a, middle, b, step);
      if (edge) return {Surface::Kind::kEdge, middle};
    }
  }
  return {Surface::Kind::kMeasured, middle};
}

}  // namespace stillpoint::moving_checks
