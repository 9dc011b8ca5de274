#include "orb_slam/fast_corners.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <opencv2/core/hal/intrin.hpp>

namespace stillpoint::orb_slam {
namespace {

// 128-bit vectors exist on every supported processor: one code path, hence the same corners
// everywhere.
using Block = cv::v_uint8x16;
constexpr int kBlock = 16;

constexpr int kCircle[16][2] = {{0, 3},  {1, 3},  {2, 2},  {3, 1},   {3, 0},   {3, -1},
                                {2, -2}, {1, -3}, {0, -3}, {-1, -3}, {-2, -2}, {-3, -1},
                                {-3, 0}, {-3, 1}, {-2, 2}, {-1, 3}};
using Circle = std::array<std::ptrdiff_t, 16>;  // offsets of its pixels in memory

Circle circle_offsets(std::ptrdiff_t step) {
  Circle offsets;
  for (int k = 0; k < 16; ++k) offsets[k] = kCircle[k][1] * step + kCircle[k][0];
  return offsets;
}

// Maximum over all arcs of nine of the minimum in the arc. Two neighbouring arcs share eight
// pixels, so eight minima of eight suffice.
inline Block best_arc(const Block (&d)[16]) {
  Block pairs[8], quads[8];
  for (int j = 0; j < 8; ++j) pairs[j] = v_min(d[2 * j + 1], d[(2 * j + 2) & 15]);
  for (int j = 0; j < 8; ++j) quads[j] = v_min(pairs[j], pairs[(j + 1) & 7]);
  Block best = cv::v_setzero_u8();
  for (int j = 0; j < 8; ++j) {
    const Block shared = v_min(quads[j], quads[(j + 2) & 7]);
    best = v_max(best, v_min(shared, v_max(d[2 * j], d[(2 * j + 9) & 15])));
  }
  return best;
}

inline bool any_set(const Block& b) { return cv::v_check_any(b != cv::v_setzero_u8()); }

// Scores of `kBlock` pixels; exact where they exceed the threshold.
inline Block score_block(const std::uint8_t* p, const Circle& circle, const Block& threshold) {
  const Block centre = cv::v_load(p);
  const Block high = centre + threshold;  // saturating, like all arithmetic here
  const Block low = centre - threshold;
  // Every arc of nine holds a pixel of each pair of opposite ones.
  Block weakest_max = cv::v_setall_u8(255), weakest_min = cv::v_setzero_u8();
  for (const int k : {0, 4, 2, 6}) {
    const Block a = cv::v_load(p + circle[k]), b = cv::v_load(p + circle[k + 8]);
    weakest_max = v_min(weakest_max, v_max(a, b));
    weakest_min = v_max(weakest_min, v_min(a, b));
    if (k == 4 && !any_set((weakest_max - high) | (low - weakest_min))) return cv::v_setzero_u8();
  }
  Block score = cv::v_setzero_u8();
  Block differences[16];
  if (any_set(weakest_max - high)) {
    for (int k = 0; k < 16; ++k) differences[k] = cv::v_load(p + circle[k]) - centre;
    score = best_arc(differences);
  }
  if (any_set(low - weakest_min)) {
    for (int k = 0; k < 16; ++k) differences[k] = centre - cv::v_load(p + circle[k]);
    score = v_max(score, best_arc(differences));
  }
  return score;
}

// Bit i: pixel i of the block beats the threshold and its eight neighbours.
inline unsigned local_maxima(const std::uint8_t* above, const std::uint8_t* here,
                             const std::uint8_t* below, const Block& threshold) {
  const Block score = cv::v_load(here);
  if (!any_set(score - threshold)) return 0;
  const Block before = v_max(v_max(cv::v_load(above - 1), cv::v_load(above)),
                             v_max(cv::v_load(above + 1), cv::v_load(here - 1)));
  const Block after = v_max(v_max(cv::v_load(below - 1), cv::v_load(below)),
                            v_max(cv::v_load(below + 1), cv::v_load(here + 1)));
  return static_cast<unsigned>(
      cv::v_signmask((score > threshold) & (score > before) & (score >= after)));
}

// Peak of the parabola through three values, from the middle one, which is the largest.
double parabola_peak(int before, int middle, int after) {
  const int curvature = 2 * middle - before - after;
  return curvature > 0 ? 0.5 * (after - before) / curvature : 0;
}

}  // namespace

cv::Point2d refine_corner(const cv::Mat& gray, const Corner& corner) {
  const Circle circle = circle_offsets(static_cast<std::ptrdiff_t>(gray.step));
  std::array<std::array<std::uint8_t, kBlock>, 3> scores;
  for (int i = 0; i < 3; ++i) {
    const std::uint8_t* p = gray.ptr(corner.y + i - 1) + corner.x - 1;
    cv::v_store(scores[i].data(), score_block(p, circle, cv::v_setzero_u8()));
  }
  return {corner.x + parabola_peak(scores[1][0], scores[1][1], scores[1][2]),
          corner.y + parabola_peak(scores[0][1], scores[1][1], scores[2][1])};
}

void FastDetector::detect(const cv::Mat& gray, int threshold, int border,
                          std::vector<Corner>& corners) {
  CV_Assert(gray.type() == CV_8UC1 && border >= kMinBorder && threshold >= 0 && threshold < 255);
  corners.clear();
  const int width = gray.cols - 2 * border, height = gray.rows - 2 * border;
  if (width <= 0 || height <= 0 || gray.cols < 2 * kBlock) return;

  // Scores of one pixel more on each side, for the comparison with neighbours. Blocks may run on
  // behind the row: into the next row of the image, which the border guarantees, and into slack.
  const std::size_t stride = static_cast<std::size_t>(width) + 2 + 2 * kBlock;
  rows_.assign(3 * stride, 0);
  const Circle circle = circle_offsets(static_cast<std::ptrdiff_t>(gray.step));
  const Block limit = cv::v_setall_u8(static_cast<std::uint8_t>(threshold));
  const auto scores = [&](int y) { return &rows_[static_cast<std::size_t>((y + 3) % 3) * stride]; };

  for (int y = -1; y <= height; ++y) {
    const std::uint8_t* image = gray.ptr(y + border) + border - 1;
    std::uint8_t* row = scores(y);
    for (int x = 0; x < width + 2; x += kBlock)
      cv::v_store(row + x, score_block(image + x, circle, limit));
    if (y < 1) continue;
    const std::uint8_t* centre = scores(y - 1) + 1;
    for (int x = 0; x < width; x += kBlock) {
      unsigned mask = local_maxima(scores(y - 2) + 1 + x, centre + x, row + 1 + x, limit);
      if (x + kBlock > width) mask &= (1u << (width - x)) - 1;
      for (; mask != 0; mask &= mask - 1) {
        const int column = x + std::countr_zero(mask);
        corners.push_back({column + border, y - 1 + border, centre[column]});
      }
    }
  }
}

}  // namespace stillpoint::orb_slam
