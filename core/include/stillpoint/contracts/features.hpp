// Point features of one image.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <opencv2/core/types.hpp>
#include <vector>

namespace stillpoint {

/// A binary descriptor of 256 bits, as of ORB or BRIEF. Others are kept by the tracker that
/// computes them; it leaves Features::descriptors empty, and recognises places by itself or not at
/// all.
using Descriptor = std::array<std::uint64_t, 4>;

/// Number of differing bits, 0 … 256.
inline int hamming_distance(const Descriptor& a, const Descriptor& b) {
  return std::popcount(a[0] ^ b[0]) + std::popcount(a[1] ^ b[1]) + std::popcount(a[2] ^ b[2]) +
         std::popcount(a[3] ^ b[3]);
}

/// Keypoints and descriptors of one image, in parallel vectors.
struct Features {
  /// px of the full image; `octave` is the pyramid level, `angle` in degrees, `size` in px.
  std::vector<cv::KeyPoint> keypoints;
  std::vector<Descriptor> descriptors;  ///< may be empty: the tracker has none of this kind
  std::vector<float> depth;             ///< metres at the keypoint, 0 = no measurement
  double scale_factor = 1.2;            ///< between two levels of the pyramid
  int levels = 8;

  std::size_t size() const { return keypoints.size(); }
};
using FeaturesPtr = std::shared_ptr<const Features>;

}  // namespace stillpoint
