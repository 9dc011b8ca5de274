#include "simulation/texture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace stillpoint::simulation {
namespace {

constexpr int kMaxTaps = 3;  // along the longer axis of a footprint

/// Four channels of two texels; compilers make one register of it.
using TwoTexels = std::uint16_t __attribute__((vector_size(16)));

TwoTexels widen(std::uint32_t first, std::uint32_t second) {
  using Bytes = std::uint8_t __attribute__((vector_size(8)));
  return __builtin_convertvector(std::bit_cast<Bytes>(first | std::uint64_t{second} << 32),
                                 TwoTexels);
}

/// log2, linear between powers of two: mip levels need no more.
float rough_log2(float x) {
  return static_cast<float>(std::bit_cast<std::int32_t>(x) - 0x3f800000) * 0x1p-23F;
}

/// Rounds down; std::floor is a function call on processors without SSE4.1, which we build for.
int floor_to_int(float x) { return static_cast<int>(x) - (x < 0 ? 1 : 0); }

int power_of_two(int size) { return static_cast<int>(std::bit_ceil(static_cast<unsigned>(size))); }

}  // namespace

Texture::Texture(const cv::Mat& bgr, Eigen::Vector2f size, float infrared)
    : periods_per_metre_(size.cwiseInverse()), infrared_(infrared) {
  cv::Mat image;
  const cv::Size finest(power_of_two(bgr.cols), power_of_two(bgr.rows));
  cv::resize(bgr, image, finest, 0, 0, cv::INTER_CUBIC);
  texels_per_metre_ = std::max(static_cast<float>(finest.width) / size.x(),
                               static_cast<float>(finest.height) / size.y());
  for (;;) {
    Level level{image.cols, image.rows, {}};
    for (const cv::Vec3b& c : cv::Mat_<cv::Vec3b>(image))
      level.texels.push_back(c[0] | std::uint32_t{c[1]} << 8 | std::uint32_t{c[2]} << 16);
    levels_.push_back(std::move(level));
    if (image.cols == 1 && image.rows == 1) break;
    const cv::Size half(std::max(1, image.cols / 2), std::max(1, image.rows / 2));
    cv::resize(image.clone(), image, half, 0, 0, cv::INTER_AREA);
  }
}

Eigen::Vector3f Texture::sample(const Eigen::Vector2f& uv, const Footprint& footprint) const {
  const float major = 2 * footprint.major.norm();
  const float minor = std::max(footprint.minor, major / kMaxTaps);
  const float level = rough_log2(std::max(minor * texels_per_metre_, 1.0F));
  const int taps = std::clamp(static_cast<int>(major / minor + 0.3F), 1, kMaxTaps);
  if (taps == 1) return trilinear(uv, level);
  Eigen::Vector3f sum = Eigen::Vector3f::Zero();
  for (int i = 0; i < taps; ++i) {
    const float along = static_cast<float>(2 * i + 1 - taps) / static_cast<float>(taps);
    sum += trilinear(uv + along * footprint.major, level);
  }
  return sum / static_cast<float>(taps);
}

Eigen::Vector3f Texture::trilinear(const Eigen::Vector2f& uv, float level) const {
  constexpr float kNegligible = 0.06F;  // weight of the other level
  const auto fine = std::min(static_cast<std::size_t>(level), levels_.size() - 1);
  const std::size_t coarse = std::min(fine + 1, levels_.size() - 1);
  const float weight = level - static_cast<float>(fine);
  if (weight < kNegligible) return bilinear(levels_[fine], uv);
  if (weight > 1 - kNegligible) return bilinear(levels_[coarse], uv);
  return (1 - weight) * bilinear(levels_[fine], uv) + weight * bilinear(levels_[coarse], uv);
}

Eigen::Vector3f Texture::bilinear(const Level& level, const Eigen::Vector2f& uv) const {
  // 24.8 fixed point; the half texel shift puts sample positions at texel centres.
  const int u =
      floor_to_int(uv.x() * periods_per_metre_.x() * static_cast<float>(256 * level.width)) - 128;
  const int v =
      floor_to_int(uv.y() * periods_per_metre_.y() * static_cast<float>(256 * level.height)) - 128;
  const int x0 = (u >> 8) & (level.width - 1);
  const int x1 = (x0 + 1) & (level.width - 1);
  const int y0 = (v >> 8) & (level.height - 1);
  const int y1 = (y0 + 1) & (level.height - 1);
  const std::uint32_t* upper = level.texels.data() + static_cast<std::ptrdiff_t>(y0) * level.width;
  const std::uint32_t* lower = level.texels.data() + static_cast<std::ptrdiff_t>(y1) * level.width;
  const auto right = static_cast<std::uint16_t>(u & 255);
  const auto left = static_cast<std::uint16_t>(256 - right);
  // At most 255 * 256: fits into 16 bits.
  const TwoTexels rows = widen(upper[x0], lower[x0]) * left + widen(upper[x1], lower[x1]) * right;
  const float down = static_cast<float>(v & 255) / 65536;
  const float up = 1.0F / 256 - down;
  return {up * rows[0] + down * rows[4], up * rows[1] + down * rows[5],
          up * rows[2] + down * rows[6]};
}

}  // namespace stillpoint::simulation
