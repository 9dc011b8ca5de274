#include "orb_slam/depth_view.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "orb_slam/observed_frame.hpp"
#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr double kStep = 2;       // px of 640 x 480, between the samples of a cell
constexpr int kSamplesAlong = 4;  // of a cell, in each direction
constexpr int kReach = 2;         // cells around a patch's own that its plane is fitted to
constexpr int kSamplesPerCell = kSamplesAlong * kSamplesAlong;
// Sensors leave holes: so many samples of a cell, and cells of a patch, must be measured.
constexpr int kMinSamples = kSamplesPerCell / 2;
constexpr int kCells = (2 * kReach + 1) * (2 * kReach + 1);
constexpr int kMinCells = 20;
constexpr float kSumOfSquares = 50.0F;  // of column (or row) over 5 × 5 cells around the middle

// Mean inverse depth, 1/m, 0 where too little is measured; and least static weight of a cell.
struct Cell {
  float inverse_depth = 0.0F;
  float weight = 0.0F;
};

// `step`: px between the samples.
Cell cell_at(const cv::Mat& depth, const cv::Mat& weights, int left, int top, int step) {
  const int right = left + kSamplesAlong * step, bottom = top + kSamplesAlong * step;
  float sum = 0.0F;
  int measured = 0;
  std::uint8_t least_weight = 255;
  for (int y = top; y < bottom; y += step) {
    const float* row = depth.ptr<float>(y);
    for (int x = left; x < right; x += step) {
      const bool is_measured = row[x] > 0;  // some sources have NaN
      sum += is_measured ? 1.0F / row[x] : 0.0F;
      measured += is_measured;
    }
    if (weights.empty()) continue;
    const std::uint8_t* weight = weights.ptr<std::uint8_t>(y);
    for (int x = left; x < right; x += step) least_weight = std::min(least_weight, weight[x]);
  }
  if (least_weight < ObservedFrame::kMinWeight) return {};
  return {measured < kMinSamples ? 0.0F : sum / static_cast<float>(measured),
          static_cast<float>(least_weight) / 255.0F};
}

// The inverse depth of a plane is an affine function of the pixel, with the same noise everywhere.
struct InversePlane {
  float middle = 0.0F;     // 1/m
  float by_column = 0.0F;  // 1/m per cell
  float by_row = 0.0F;     // 1/m per cell
  float weight = 0.0F;
};

// 1/m that a cell's mean may be off the plane; more is a discontinuity. Six standard deviations of
// the mean of its samples, and no less than those of a Kinect: better sensors do not make surfaces
// flatter.
constexpr float kLeastMisfit = 0.003F;
float max_misfit(float surface_noise) {
  return std::max(kLeastMisfit, 6.0F * surface_noise / std::sqrt(float{kSamplesPerCell}));
}

// Least squares over the measured cells. Those that are not have an inverse depth of 0, and add
// nothing to the sums; the Hessian is that of all cells less theirs.
InversePlane fit(const std::vector<Cell>& cells, int columns, int column, int row,
                 float max_misfit) {
  const auto cell = [&](int dx, int dy) -> const Cell& {
    return cells[static_cast<std::size_t>((row + dy) * columns + column + dx)];
  };
  float weight = 1.0F;
  Eigen::Vector3f sums = Eigen::Vector3f::Zero();
  Eigen::Matrix3f hessian = Eigen::Vector3f(kCells, kSumOfSquares, kSumOfSquares).asDiagonal();
  for (int dy = -kReach; dy <= kReach; ++dy) {
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const Cell& c = cell(dx, dy);
      const Eigen::Vector3f place(1, static_cast<float>(dx), static_cast<float>(dy));
      weight = std::min(weight, c.weight);
      sums += c.inverse_depth * place;
      if (c.inverse_depth <= 0) hessian -= place * place.transpose();
    }
  }
  if (weight <= 0 || hessian(0, 0) < kMinCells) return {};
  const Eigen::Vector3f plane = hessian.inverse() * sums;
  for (int dy = -kReach; dy <= kReach; ++dy)
    for (int dx = -kReach; dx <= kReach; ++dx) {
      const float measured = cell(dx, dy).inverse_depth;
      const float expected =
          plane.x() + static_cast<float>(dx) * plane.y() + static_cast<float>(dy) * plane.z();
      if (measured > 0 && std::abs(expected - measured) > max_misfit) return {};
    }
  return {.middle = plane.x(), .by_column = plane.y(), .by_row = plane.z(), .weight = weight};
}

}  // namespace

DepthView::DepthView(const Frame& frame, const StaticWeights& weights) {
  const int step = std::max(1, cvRound(kStep * pixel_scale(frame.depth.size())));
  cell_ = kSamplesAlong * step;
  columns_ = frame.depth.cols / cell_;
  rows_ = frame.depth.rows / cell_;
  const Camera& camera = *frame.camera;
  noise_ = static_cast<float>(camera.surface_noise);
  focal_ = Eigen::Vector2d(camera.fx, camera.fy).cast<float>();
  centre_ = Eigen::Vector2d(camera.cx, camera.cy).cast<float>();
  std::vector<Cell> cells(static_cast<std::size_t>(columns_ * rows_));
  for (int row = 0; row < rows_; ++row)
    for (int column = 0; column < columns_; ++column)
      cells[static_cast<std::size_t>(row * columns_ + column)] =
          cell_at(frame.depth, weights.track, column * cell_, row * cell_, step);

  patches_.resize(cells.size());
  const float misfit = max_misfit(noise_);
  // Mean of a cell's sample positions.
  const float middle = static_cast<float>(cell_ - step) / 2.0F;
  for (int row = kReach; row < rows_ - kReach; ++row) {
    for (int column = kReach; column < columns_ - kReach; ++column) {
      const InversePlane plane = fit(cells, columns_, column, row, misfit);
      if (plane.weight <= 0 || plane.middle <= 0) continue;
      const Eigen::Vector2f pixel(static_cast<float>(column * cell_) + middle,
                                  static_cast<float>(row * cell_) + middle);
      const Eigen::Vector2f ray = (pixel - centre_).cwiseQuotient(focal_);
      // On a plane n·x = d, 1/z = (n_x ray_x + n_y ray_y + n_z) / d.
      const Eigen::Vector2f slope =
          Eigen::Vector2f(plane.by_column, plane.by_row).cwiseProduct(focal_) /
          static_cast<float>(cell_);
      const Eigen::Vector3f normal(-slope.x(), -slope.y(), slope.dot(ray) - plane.middle);
      patches_[static_cast<std::size_t>(row * columns_ + column)] = {
          .point = Eigen::Vector3f(ray.x(), ray.y(), 1.0F) / plane.middle,
          .normal = normal.normalized(),
          .weight = plane.weight};
    }
  }
}

const PlanePatch* DepthView::at(const Eigen::Vector3f& point) const {
  if (point.z() <= 0) return nullptr;
  const Eigen::Vector2f pixel =
      point.head<2>().cwiseProduct(focal_) / point.z() + centre_ + Eigen::Vector2f(0.5F, 0.5F);
  const int column = static_cast<int>(std::floor(pixel.x() / static_cast<float>(cell_)));
  const int row = static_cast<int>(std::floor(pixel.y() / static_cast<float>(cell_)));
  if (column < 0 || column >= columns_ || row < 0 || row >= rows_) return nullptr;
  const PlanePatch& found = patch(column, row);
  return found.weight > 0 ? &found : nullptr;
}

float DepthView::distance_sigma(const PlanePatch& patch) const {
  return std::abs(patch.normal.dot(patch.point)) * patch.point.z() * noise_;
}

float DepthView::normal_sigma(const PlanePatch& patch) const {
  const float cell_sigma = noise_ / std::sqrt(static_cast<float>(kSamplesPerCell));
  return cell_sigma / std::sqrt(kSumOfSquares) * focal_.x() / static_cast<float>(cell_) *
         patch.point.z();
}

}  // namespace stillpoint::orb_slam
