// A picture on a surface, filtered by the size of a pixel on that surface (mip levels), so that
// fine detail neither aliases nor shimmers when the camera moves.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace stillpoint::simulation {

/// The part of a surface one pixel sees, in metres on the surface.
struct Footprint {
  Eigen::Vector2f major;  ///< half of the longer axis, as a vector
  float minor = 0;        ///< length of the shorter axis
};

class Texture {
 public:
  /// `bgr` CV_8UC3 covers `size` metres and repeats beyond. `infrared` is the share of the depth
  /// sensor's light that comes back at right angles.
  Texture(const cv::Mat& bgr, Eigen::Vector2f size, float infrared = 1.0F);

  /// Mean colour (b, g, r in 0…255) in a footprint around `uv`, metres.
  Eigen::Vector3f sample(const Eigen::Vector2f& uv, const Footprint& footprint) const;

  float infrared() const { return infrared_; }

 private:
  struct Level {
    int width;   // a power of two
    int height;  // a power of two
    std::vector<std::uint32_t> texels;
  };

  Eigen::Vector3f trilinear(const Eigen::Vector2f& uv, float level) const;
  Eigen::Vector3f bilinear(const Level& level, const Eigen::Vector2f& uv) const;

  std::vector<Level> levels_;
  Eigen::Vector2f periods_per_metre_;
  float texels_per_metre_;  // of the finer axis, finest level
  float infrared_;
};

}  // namespace stillpoint::simulation
