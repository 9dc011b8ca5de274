#include "orb_slam/orb_descriptor.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <opencv2/core/hal/intrin.hpp>
#include <utility>

#include "orb_slam/orb_pattern.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr int kRadius = 15;
static_assert(kPatternRadius <= kPatchBorder && kRadius + 1 <= kPatchBorder);

// Row v of the disc as a mask over columns -15 … 16.
using DiscRow = std::array<std::uint8_t, 2 * kRadius + 2>;
constexpr std::array<DiscRow, kRadius + 1> disc_rows() {
  std::array<DiscRow, kRadius + 1> rows{};
  for (int v = 0; v <= kRadius; ++v)
    for (int u = -kRadius; u <= kRadius; ++u)
      if (4 * (u * u + v * v) < (2 * kRadius + 1) * (2 * kRadius + 1)) rows[v][u + kRadius] = 255;
  return rows;
}
constexpr std::array<DiscRow, kRadius + 1> kDisc = disc_rows();

constexpr std::array<std::int16_t, 2 * kRadius + 2> column_numbers() {
  std::array<std::int16_t, 2 * kRadius + 2> columns{};
  for (int i = 0; i < 2 * kRadius + 2; ++i) columns[i] = static_cast<std::int16_t>(i - kRadius);
  return columns;
}
constexpr std::array<std::int16_t, 2 * kRadius + 2> kColumns = column_numbers();

// Half a row of the disc, widened to 16 bits.
std::pair<cv::v_int16x8, cv::v_int16x8> load_masked(const std::uint8_t* pixels,
                                                    const std::uint8_t* mask) {
  cv::v_uint16x8 low, high;
  v_expand(cv::v_load(pixels) & cv::v_load(mask), low, high);
  return {cv::v_reinterpret_as_s16(low), cv::v_reinterpret_as_s16(high)};
}

// Both moments of 16 columns of the disc, the first of which is `half * 16`. Sums of a column stay
// below 2^15: 31 * 255 grey levels, and 15 * 16 / 2 * 255 when weighted with the row.
std::pair<int, int> moments(const std::uint8_t* centre, std::ptrdiff_t step, int half) {
  const std::uint8_t* first = centre - kRadius + 16 * half;
  const auto mask = [half](int v) { return &kDisc[v][16 * half]; };
  auto [sum_low, sum_high] = load_masked(first, mask(0));
  cv::v_int16x8 weighted_low = cv::v_setzero_s16(), weighted_high = cv::v_setzero_s16();
  for (int v = 1; v <= kRadius; ++v) {
    const auto [below_low, below_high] = load_masked(first + v * step, mask(v));
    const auto [above_low, above_high] = load_masked(first - v * step, mask(v));
    const cv::v_int16x8 row = cv::v_setall_s16(static_cast<std::int16_t>(v));
    sum_low = sum_low + below_low + above_low;
    sum_high = sum_high + below_high + above_high;
    weighted_low = weighted_low + v_mul_wrap(below_low - above_low, row);
    weighted_high = weighted_high + v_mul_wrap(below_high - above_high, row);
  }
  const cv::v_int16x8 one = cv::v_setall_s16(1);
  const std::int16_t* columns = &kColumns[16 * half];
  const int m10 = v_reduce_sum(v_dotprod(sum_low, cv::v_load(columns)) +
                               v_dotprod(sum_high, cv::v_load(columns + 8)));
  const int m01 = v_reduce_sum(v_dotprod(weighted_low, one) + v_dotprod(weighted_high, one));
  return {m10, m01};
}

// All first points of the tests, then all second ones.
struct PatternPoints {
  alignas(16) std::int16_t x[512], y[512];
};
PatternPoints split_pattern() {
  PatternPoints points;
  for (int i = 0; i < 256; ++i) {
    points.x[i] = kOrbPattern[i].x1;
    points.y[i] = kOrbPattern[i].y1;
    points.x[i + 256] = kOrbPattern[i].x2;
    points.y[i + 256] = kOrbPattern[i].y2;
  }
  return points;
}

// a * p - b * q, rounded from 1/1024 to whole px. |a * p| + |b * q| stays below 2^15.
cv::v_int16x8 rotated(const cv::v_int16x8& a, const cv::v_int16x8& p, const cv::v_int16x8& b,
                      const cv::v_int16x8& q) {
  const auto half = cv::v_setall_s16(Direction::kOne / 2);
  return (v_mul_wrap(a, p) - v_mul_wrap(b, q) + half) >> 10;
}

// Offsets in memory of the rotated points.
void rotate_pattern(const Direction& direction, int step, std::int32_t* offsets) {
  static const PatternPoints points = split_pattern();
  const auto cosine = cv::v_setall_s16(static_cast<std::int16_t>(direction.cosine));
  const auto sine = cv::v_setall_s16(static_cast<std::int16_t>(direction.sine));
  const auto minus_sine = cv::v_setall_s16(static_cast<std::int16_t>(-direction.sine));
  cv::v_int16x8 one_and_step, unused;
  v_zip(cv::v_setall_s16(1), cv::v_setall_s16(static_cast<std::int16_t>(step)), one_and_step,
        unused);
  for (int i = 0; i < 512; i += 8) {
    const cv::v_int16x8 x = cv::v_load(points.x + i), y = cv::v_load(points.y + i);
    cv::v_int16x8 low, high;  // x and y in turns
    v_zip(rotated(cosine, x, sine, y), rotated(cosine, y, minus_sine, x), low, high);
    cv::v_store(offsets + i, v_dotprod(low, one_and_step));
    cv::v_store(offsets + i + 4, v_dotprod(high, one_and_step));
  }
}

}  // namespace

Direction patch_direction(const cv::Mat& gray, int x, int y) {
  const std::uint8_t* centre = gray.ptr(y) + x;
  const auto step = static_cast<std::ptrdiff_t>(gray.step);
  const auto [left10, left01] = moments(centre, step, 0);
  const auto [right10, right01] = moments(centre, step, 1);
  const double m10 = left10 + right10, m01 = left01 + right01;
  const double length = std::sqrt(m10 * m10 + m01 * m01);  // the sum is exact: below 2^53
  if (length == 0) return {};
  return {static_cast<int>(std::lround(Direction::kOne * m10 / length)),
          static_cast<int>(std::lround(Direction::kOne * m01 / length))};
}

float angle_degrees(const Direction& direction) {
  const double c = std::abs(direction.cosine), s = std::abs(direction.sine);
  const double z = std::min(c, s) / std::max(c, s), z2 = z * z;
  // Abramowitz and Stegun 4.4.49: unlike std::atan2, no function of the C library's choice.
  double angle =
      z * (0.9998660 + z2 * (-0.3302995 + z2 * (0.1801410 + z2 * (-0.0851330 + z2 * 0.0208351))));
  angle *= 180 / std::numbers::pi;
  if (s > c) angle = 90 - angle;
  if (direction.cosine < 0) angle = 180 - angle;
  if (direction.sine < 0) angle = 360 - angle;
  return static_cast<float>(angle);
}

Descriptor orb_descriptor(const cv::Mat& blurred, int x, int y, const Direction& direction) {
  CV_Assert(blurred.step <= kMaxImageWidth);
  alignas(16) std::int32_t offsets[512];
  rotate_pattern(direction, static_cast<int>(blurred.step), offsets);
  const std::uint8_t* centre = blurred.ptr(y) + x;
  Descriptor descriptor;
  for (std::size_t word = 0; word < descriptor.size(); ++word) {
    std::uint64_t bits = 0;
    for (std::size_t bit = 0; bit < 64; ++bit) {
      const std::size_t test = 64 * word + bit;
      const bool darker = centre[offsets[test]] < centre[offsets[test + 256]];
      bits |= std::uint64_t{darker} << bit;
    }
    descriptor[word] = bits;
  }
  return descriptor;
}

}  // namespace stillpoint::orb_slam
