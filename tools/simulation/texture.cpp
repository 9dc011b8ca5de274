#include "simulation/texture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace stillpoint::simulation {
namespace {

constexpr int kMaxTaps = 3;  // along the longer axis of a footprint

/// Weighted mean of four 8-bit channels at once; `weight` of b in 1/256.
std::uint32_t lerp(std::uint32_t a, std::uint32_t b, std::uint32_t weight) {
  constexpr std::uint32_t kMask = 0x00ff00ffU;
  const std::uint32_t even =
      (((a & kMask) * (256 - weight) + (b & kMask) * weight + 0x00800080U) >> 8) & kMask;
  const std::uint32_t odd =
      (((a >> 8) & kMask) * (256 - weight) + ((b >> 8) & kMask) * weight + 0x00800080U) & ~kMask;
  return even | odd;
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
  Eigen::Array3i sum = Eigen::Array3i::Zero();
  for (int i = 0; i < taps; ++i) {
    const float along = static_cast<float>(2 * i + 1 - taps) / static_cast<float>(taps);
    const auto c = static_cast<int>(trilinear(uv + along * footprint.major, level));
    sum += Eigen::Array3i(c & 255, (c >> 8) & 255, (c >> 16) & 255);
  }
  return sum.cast<float>() / static_cast<float>(taps);
}

std::uint32_t Texture::trilinear(const Eigen::Vector2f& uv, float level) const {
  const auto fine = static_cast<std::size_t>(level);
  if (fine + 1 >= levels_.size()) return bilinear(levels_.back(), uv);
  const auto weight = static_cast<std::uint32_t>((level - static_cast<float>(fine)) * 256);
  const std::uint32_t color = bilinear(levels_[fine], uv);
  return weight == 0 ? color : lerp(color, bilinear(levels_[fine + 1], uv), weight);
}

std::uint32_t Texture::bilinear(const Level& level, const Eigen::Vector2f& uv) const {
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
  const auto wx = static_cast<std::uint32_t>(u & 255);
  return lerp(lerp(upper[x0], upper[x1], wx), lerp(lower[x0], lower[x1], wx),
              static_cast<std::uint32_t>(v & 255));
}

}  // namespace stillpoint::simulation
