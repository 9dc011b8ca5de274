#include "map_checks/depth_cells.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace stillpoint::map_checks {
namespace {

constexpr float kSurfaceEdge = 0.06F;  // of the depth, between neighbouring cells of one surface
constexpr float kCellEdge = 0.03F;     // of the depth, within a cell on one surface

/// The median of a cell that is on one surface; 0 where it is not, or has depth in less than half
/// of it. Beside a depth edge, the median would move the edge. `u`, `v`: the cell's first pixel.
float median_of_cell(const cv::Mat& depth, int u, int v) {
  std::array<float, kCell * kCell> measured;
  auto end = measured.begin();
  for (int y = v; y < v + kCell; ++y) {
    const auto* row = depth.ptr<float>(y);
    end = std::copy_if(row + u, row + u + kCell, end, [](float z) { return z > 0; });
  }
  const auto count = end - measured.begin();
  if (2 * count < std::ssize(measured)) return 0;
  const auto [near, far] = std::minmax_element(measured.begin(), end);
  if (*far - *near > kCellEdge * *near) return 0;
  const auto middle = measured.begin() + count / 2;
  std::nth_element(measured.begin(), middle, end);
  return *middle;
}

}  // namespace

CellCamera::CellCamera(const Camera& camera)
    : fx(static_cast<float>(camera.fx / kCell)),
      fy(static_cast<float>(camera.fy / kCell)),
      cx(static_cast<float>((camera.cx - kCellMiddle) / kCell)),
      cy(static_cast<float>((camera.cy - kCellMiddle) / kCell)),
      surface_noise(static_cast<float>(camera.surface_noise)) {}

cv::Mat sample_depth(const cv::Mat& depth) {
  cv::Mat cells(depth.rows / kCell, depth.cols / kCell, CV_32F);
  for (int y = 0; y < cells.rows; ++y) {
    const auto* in = depth.ptr<float>(y * kCell + kCellMiddle) + kCellMiddle;
    auto* out = cells.ptr<float>(y);
    for (int x = 0; x < cells.cols; ++x) {
      const float middle = in[x * kCell];
      out[x] = middle > 0 ? middle : median_of_cell(depth, x * kCell, y * kCell);
    }
  }
  return cells;
}

cv::Mat depth_bounds(const cv::Mat& cells) {
  constexpr float kNowhere = std::numeric_limits<float>::max();
  const cv::Mat none = cells <= 0;
  const cv::Mat around = cv::Mat::ones(3, 3, CV_8U);
  cv::Mat near = cells.clone(), far;
  near.setTo(kNowhere, none);
  cv::erode(near, near, around);
  cv::dilate(cells, far, around);
  near.setTo(0, none);
  far.setTo(0, none);
  cv::Mat bounds;
  cv::merge(std::vector<cv::Mat>{near, far}, bounds);
  return bounds;
}

cv::Mat surface_normals(const cv::Mat& cells, const CellCamera& camera) {
  cv::Mat normals = cv::Mat::zeros(cells.size(), CV_32FC3);
  for (int y = 1; y + 1 < cells.rows; ++y) {
    const auto* above = cells.ptr<float>(y - 1);
    const auto* row = cells.ptr<float>(y);
    const auto* below = cells.ptr<float>(y + 1);
    auto* out = normals.ptr<cv::Vec3f>(y);
    for (int x = 1; x + 1 < cells.cols; ++x) {
      const float z = row[x], left = row[x - 1], right = row[x + 1];
      const float edge = kSurfaceEdge * z;
      const auto apart = [&](float other) { return other <= 0 || std::abs(other - z) > edge; };
      if (z <= 0 || apart(left) || apart(right) || apart(above[x]) || apart(below[x])) continue;
      const auto u = static_cast<float>(x), v = static_cast<float>(y);
      const Eigen::Vector3f along =
          camera.unproject(u + 1, v, right) - camera.unproject(u - 1, v, left);
      const Eigen::Vector3f down =
          camera.unproject(u, v + 1, below[x]) - camera.unproject(u, v - 1, above[x]);
      const Eigen::Vector3f normal = down.cross(along).normalized();  // towards the camera
      out[x] = {normal.x(), normal.y(), normal.z()};
    }
  }
  return normals;
}

}  // namespace stillpoint::map_checks
