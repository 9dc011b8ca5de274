// A depth image as a grid of small planes: what point-to-plane registration works on.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/static_weights.hpp"

namespace stillpoint::orb_slam {

/// A piece of a surface, in the frame of the camera that measured it.
struct PlanePatch {
  Eigen::Vector3f point = Eigen::Vector3f::Zero();   ///< metres, on the ray of the patch's middle
  Eigen::Vector3f normal = Eigen::Vector3f::Zero();  ///< unit length, towards the camera
  float weight = 0.0F;  ///< probability that it is static, 0 … 1; 0: no plane was found here
};

/// Every patch is the plane that fits best to five by five cells around its middle. A cell has 8 ×
/// 8 px in images of 640 × 480, and scales with the image, in steps of 4 px. Depth discontinuities,
/// curved surfaces and regions of low static weight have no patch.
class DepthView {
 public:
  DepthView() = default;
  DepthView(const Frame& frame, const StaticWeights& weights);

  int cell() const { return cell_; }  ///< px between patches
  int columns() const { return columns_; }
  int rows() const { return rows_; }
  const PlanePatch& patch(int column, int row) const {
    return patches_[static_cast<std::size_t>(row) * columns_ + column];
  }
  /// The patch whose cell a point in this view's camera frame falls into; null when it is outside
  /// the image or there is none.
  const PlanePatch* at(const Eigen::Vector3f& point) const;

  /// Standard deviation of the inverse depth of one pixel, 1/m (Camera::surface_noise).
  float surface_noise() const { return noise_; }
  /// Standard deviations of a patch: of its distance along its normal (metres) and of the direction
  /// of its normal (radians).
  float distance_sigma(const PlanePatch& patch) const;
  float normal_sigma(const PlanePatch& patch) const;

 private:
  int cell_ = 1;  // px
  int columns_ = 0;
  int rows_ = 0;
  float noise_ = 0.0F;            // 1/m, of the inverse depth of one pixel
  Eigen::Vector2f focal_{1, 1};   // px
  Eigen::Vector2f centre_{0, 0};  // px
  std::vector<PlanePatch> patches_;
};

}  // namespace stillpoint::orb_slam
