#include "simulation/sensor.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "simulation/noise.hpp"
#include "simulation/parallel.hpp"

namespace stillpoint::simulation {
namespace {

constexpr int kLattice = 5;  // px; neighbours share errors because windows are matched, not pixels

std::uint16_t encode(double metres, double depth_factor) {
  const double value = metres * depth_factor + 0.5;
  return value < 65536 ? static_cast<std::uint16_t>(value) : 0;
}

/// Distance of what is not measured, metres.
constexpr float kNothing = std::numeric_limits<float>::infinity();

/// Of numbers above -1000; std::lround is a slow function call.
int round_to_int(float x) { return static_cast<int>(x + 1000.5F) - 1000; }

/// Pixels which the projector, right of the camera, cannot reach: another surface is in the way.
/// The light on a pixel left the projector in column x - bf / z; what is nearer covers the columns
/// of what is farther and seen left of it.
std::vector<std::uint8_t> shadow_row(const float* depth, int width, float baseline_focal) {
  constexpr float kTolerance = 1.0F;  // px; a slanted surface does not shade itself
  std::vector<std::uint8_t> shadow(static_cast<std::size_t>(width));
  float covered = std::numeric_limits<float>::infinity();
  for (int x = width - 1; x >= 0; --x) {
    if (depth[x] <= 0) continue;
    const float column = static_cast<float>(x) - baseline_focal / depth[x];
    shadow[static_cast<std::size_t>(x)] = column > covered + kTolerance;
    covered = std::min(covered, column);
  }
  return shadow;
}

/// Errors that neighbours share: normal values on a lattice, linear in between, for one row.
class LatticeNoise {
 public:
  LatticeNoise(std::uint32_t seed, std::uint32_t frame, int row)
      : above_(seed, frame, Stream::kDepthLattice, row / kLattice),
        below_(seed, frame, Stream::kDepthLattice, row / kLattice + 1),
        down_(static_cast<float>(row % kLattice) / kLattice) {}

  float at(int column) {
    if (column / kLattice != cell_) {
      cell_ = column / kLattice;
      left_ = blend(cell_);
      right_ = blend(cell_ + 1);
    }
    const float t = static_cast<float>(column % kLattice) / kLattice;
    return left_ + t * (right_ - left_);
  }

 private:
  float blend(int cell) const {
    const float a = above_.normal(cell);
    return a + down_ * (below_.normal(cell) - a);
  }

  RowNoise above_;
  RowNoise below_;
  float down_;
  int cell_ = -1;
  float left_ = 0;
  float right_ = 0;
};

}  // namespace

float Sensor::gain(double time) const {
  const RowNoise random(seed_, 0, Stream::kColor, -1);
  const double phase = 2 * M_PI * random.uniform(0);
  return static_cast<float>(
      1 + options_.exposure_drift *
              (0.7 * std::sin(0.35 * time + phase) + 0.3 * std::sin(1.13 * time + 2 * phase)));
}

cv::Mat Sensor::color_image(const View& view, int frame, double time) const {
  cv::Mat image(view.color.size(), CV_8UC3);
  if (options_.ideal) {
    view.color.convertTo(image, CV_8U);
    return image;
  }
  // Photons: variance grows with brightness. Scaled to color_noise at middle grey.
  std::array<float, 256> sigma{};
  for (std::size_t i = 0; i < sigma.size(); ++i)
    sigma[i] = static_cast<float>(options_.color_noise *
                                  std::sqrt((static_cast<double>(i) + 24) / (128 + 24)));
  const float brightness = gain(time);
  const float middle_x = 0.5F * static_cast<float>(image.cols);
  const float middle_y = 0.5F * static_cast<float>(image.rows);
  const float corner = middle_x * middle_x + middle_y * middle_y;
  parallel_for(threads_, image.rows, [&](int y) {
    const RowNoise noise(seed_, static_cast<std::uint32_t>(frame), Stream::kColor, y);
    const auto* in = view.color.ptr<cv::Vec3f>(y);
    auto* out = image.ptr<cv::Vec3b>(y);
    const float dy = static_cast<float>(y) - middle_y;
    for (int x = 0; x < image.cols; ++x) {
      const float dx = static_cast<float>(x) - middle_x;
      const float light = brightness * (1 - 0.12F * (dx * dx + dy * dy) / corner);
      const std::uint32_t bits = noise.bits(x);
      for (int c = 0; c < 3; ++c) {
        const float value = std::min(in[x][c] * light, 255.0F);
        const float error =
            sigma[static_cast<std::size_t>(value)] * normal_from_bits(bits << (10 * c));
        out[x][c] = cv::saturate_cast<std::uint8_t>(value + error);
      }
    }
  });
  return image;
}

cv::Mat Sensor::depth_image(const View& view, int frame) const {
  cv::Mat image(view.depth.size(), CV_16U);
  parallel_for(threads_, image.rows, [&](int y) {
    auto* out = image.ptr<std::uint16_t>(y);
    if (options_.ideal) {
      for (int x = 0; x < image.cols; ++x)
        out[x] = encode(view.depth.at<float>(y, x), depth_factor_);
    } else {
      measure_row(view, frame, y, out);
    }
  });
  return image;
}

void Sensor::measure_row(const View& view, int frame, int y, std::uint16_t* out) const {
  const auto id = static_cast<std::uint32_t>(frame);
  const RowNoise white(seed_, id, Stream::kDepthWhite, y);
  LatticeNoise shared(seed_, id, y);
  // Shares of the variance; the lattice keeps 4/9 of its own between its points, on average.
  const auto sigma_white = static_cast<float>(options_.disparity_noise * std::sqrt(0.3));
  const auto sigma_shared = static_cast<float>(options_.disparity_noise * std::sqrt(0.7 * 9 / 4));
  const std::vector<float> seen = seen_row(view, frame, y);
  const auto focal = static_cast<float>(options_.baseline_focal);
  const auto step = static_cast<float>(options_.disparity_step);
  for (int x = 0; x < view.depth.cols; ++x) {
    out[x] = 0;
    const float z = seen[static_cast<std::size_t>(x)];
    if (z == kNothing) continue;
    const float noise = sigma_white * white.normal(x) + sigma_shared * shared.at(x);
    const float disparity = focal / z + noise;
    const float measured =
        step > 0 ? step * static_cast<float>(round_to_int(disparity / step)) : disparity;
    if (measured > 0) out[x] = encode(focal / measured, depth_factor_);
  }
}

std::vector<float> Sensor::seen_row(const View& view, int frame, int y) const {
  constexpr float kEdge = 0.06F;     // relative step of depth that is an edge
  constexpr float kEdgeLoss = 0.3F;  // share of pixels lost at edges
  constexpr float kWander = 0.4F;    // px, standard deviation of where an edge is seen
  constexpr float kDark = 0.03F;     // infrared: never measured below this,
  constexpr float kBright = 0.12F;   // always above that
  const auto id = static_cast<std::uint32_t>(frame);
  const RowNoise white(seed_, id, Stream::kDepthWhite, y);
  const RowNoise jitter(seed_, id, Stream::kDepthJitter, y);
  const cv::Mat& depth = view.depth;
  std::vector<float> seen(static_cast<std::size_t>(depth.cols), kNothing);
  const std::vector<std::uint8_t> shadow =
      shadow_row(depth.ptr<float>(y), depth.cols, static_cast<float>(options_.baseline_focal));
  const auto min_range = static_cast<float>(options_.min_range);
  const auto max_range = static_cast<float>(options_.max_range);
  for (int x = 0; x < depth.cols; ++x) {
    if (shadow[static_cast<std::size_t>(x)]) continue;
    const std::uint32_t bits = jitter.bits(x);
    const int from_x =
        std::clamp(x + round_to_int(kWander * normal_from_bits(bits)), 0, depth.cols - 1);
    const int from_y =
        std::clamp(y + round_to_int(kWander * normal_from_bits(bits << 16)), 0, depth.rows - 1);
    const float here = depth.at<float>(y, x);
    float z = depth.at<float>(from_y, from_x);
    // Sub-pixel wander matters at edges only; on a surface it would add noise of its own.
    if (std::abs(z - here) < kEdge * here) z = here;
    if (z < min_range || z > max_range) continue;
    const float random = static_cast<float>(white.bits(x) & 0xffff) / 0x1p16F;
    const float light = view.infrared.at<float>(from_y, from_x);
    if (light < kDark + (kBright - kDark) * random) continue;
    const float left = depth.at<float>(y, std::max(x - 1, 0));
    const float right = depth.at<float>(y, std::min(x + 1, depth.cols - 1));
    const bool edge = std::abs(left - right) > kEdge * here;
    if (edge && random < kEdgeLoss) continue;
    seen[static_cast<std::size_t>(x)] = z;
  }
  return seen;
}

}  // namespace stillpoint::simulation
