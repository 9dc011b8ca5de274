// A picture on a surface, filtered by the size of a pixel on that surface (mip levels), so that
// fine detail neither aliases nor shimmers when the camera moves.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <opencv2/core/mat.hpp>

namespace stillpoint::simulation {

/// The part of a surface one pixel sees, in metres on the surface.
struct Footprint {
  Eigen::Vector2f major;  ///< half of the longer axis, as a vector
  float minor = 0;        ///< length of the shorter axis
};

/// How to sample a texture for a footprint; neighbouring pixels may share it.
struct TextureFilter {
  int level = 0;               ///< of the half octaves of detail
  int taps = 1;                ///< along the longer axis
  Eigen::Vector2f first_uv;    ///< metres from the middle to the first tap
  Eigen::Vector2f between_uv;  ///< metres from one tap to the next
};

class Pyramid;

/// A copy shares the picture. Safe to use from any thread.
class Texture {
 public:
  /// `bgr` CV_8UC3, not to be changed afterwards, covers `size` metres and repeats beyond.
  /// `infrared` is the share of the depth sensor's light that comes back at right angles.
  Texture(const cv::Mat& bgr, Eigen::Vector2f size, float infrared = 1.0F);

  TextureFilter filter(const Footprint& footprint) const;
  /// Mean colour (b, g, r in 0…255) around `uv`, metres.
  Eigen::Vector3f sample(const Eigen::Vector2f& uv, const TextureFilter& filter) const;

  float infrared() const { return infrared_; }

 private:
  std::shared_ptr<const Pyramid> pyramid_;
  float texels_per_metre_;  // of the finer axis, finest level
  float infrared_;
};

}  // namespace stillpoint::simulation
