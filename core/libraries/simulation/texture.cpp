#include "simulation/texture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "simulation/pyramid.hpp"

namespace stillpoint::simulation {
namespace {

constexpr int kMaxTaps = 3;  // along the longer axis of a footprint

/// Four channels of two texels; compilers make one register of it. Bytes and words are widened by
/// mixing them with zeros, which compilers turn into one instruction.
using TwoTexels = std::uint16_t __attribute__((vector_size(16)));
using Color = float __attribute__((vector_size(16)));

TwoTexels widen(std::uint32_t first, std::uint32_t second) {
  using SixteenBytes = std::uint8_t __attribute__((vector_size(16)));
  using Words = std::uint32_t __attribute__((vector_size(16)));
  const auto bytes = std::bit_cast<SixteenBytes>(Words{first, second});
  return std::bit_cast<TwoTexels>(__builtin_shufflevector(bytes, SixteenBytes{}, 0, 16, 1, 17, 2,
                                                          18, 3, 19, 4, 20, 5, 21, 6, 22, 7, 23));
}

/// Of the first or the second texel.
template <int First>
Color channels(TwoTexels texels) {
  using Integers = std::int32_t __attribute__((vector_size(16)));
  const TwoTexels wide = __builtin_shufflevector(texels, TwoTexels{}, First, 8, First + 1, 9,
                                                 First + 2, 10, First + 3, 11);
  return __builtin_convertvector(std::bit_cast<Integers>(wide), Color);
}

/// log2, linear between powers of two: mip levels need no more.
float rough_log2(float x) {
  return static_cast<float>(std::bit_cast<std::int32_t>(x) - 0x3f800000) * 0x1p-23F;
}

/// Rounds down; std::floor is a function call on processors without SSE4.1, which we build for.
int floor_to_int(float x) { return static_cast<int>(x) - (x < 0 ? 1 : 0); }

/// Mean of four texels, weighted by where between them (u, v), in 1/256 texels, lies.
Color bilinear(const PyramidLevel& level, int u, int v) {
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
  return up * channels<0>(rows) + down * channels<4>(rows);
}

}  // namespace

Texture::Texture(const cv::Mat& bgr, Eigen::Vector2f size, float infrared)
    : pyramid_(std::make_shared<Pyramid>(bgr, size)),
      texels_per_metre_(std::max(static_cast<float>(pyramid_->finest().width) / size.x(),
                                 static_cast<float>(pyramid_->finest().height) / size.y())),
      infrared_(infrared) {}

TextureFilter Texture::filter(const Footprint& footprint) const {
  const float major = 2 * footprint.major.norm();
  const float minor = std::max(footprint.minor, major / kMaxTaps);
  const float half_octaves = 2 * rough_log2(std::max(minor * texels_per_metre_, 1.0F));
  // The nearest level is never more than 19 % off, which nobody sees; no need to mix two.
  TextureFilter filter{
      .level = std::min(static_cast<int>(half_octaves + 0.5F), pyramid_->level_count() - 1),
      .taps = std::clamp(static_cast<int>(major / minor + 0.3F), 1, kMaxTaps)};
  const auto taps = static_cast<float>(filter.taps);
  filter.between_uv = footprint.major * (2 / taps);
  filter.first_uv = footprint.major * (1 / taps - 1);
  return filter;
}

Eigen::Vector3f Texture::sample(const Eigen::Vector2f& uv, const TextureFilter& filter) const {
  const PyramidLevel& level = pyramid_->level(filter.level);
  const Eigen::Vector2f at = (uv + filter.first_uv).cwiseProduct(level.from_uv);
  const Eigen::Vector2f step = filter.between_uv.cwiseProduct(level.from_uv);
  // The half texel shift puts sample positions at texel centres.
  int u = floor_to_int(at.x()) - 128;
  int v = floor_to_int(at.y()) - 128;
  Color sum = bilinear(level, u, v);
  for (int i = 1; i < filter.taps; ++i) {
    u += static_cast<int>(step.x());
    v += static_cast<int>(step.y());
    sum += bilinear(level, u, v);
  }
  sum *= 1 / static_cast<float>(filter.taps);
  return {sum[0], sum[1], sum[2]};
}

}  // namespace stillpoint::simulation
