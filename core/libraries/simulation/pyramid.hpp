// The levels of detail of a picture, half an octave apart. Each is made when it is first looked at:
// most pictures of a room are never seen from near, and the finest levels take most of the time and
// of the memory.
#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace stillpoint::simulation {

/// A picture whose sides are powers of two.
struct PyramidLevel {
  int width;
  int height;
  Eigen::Vector2f from_uv;            ///< 1/256 texels per metre
  std::vector<std::uint32_t> texels;  ///< rows; blue, green and red from the lowest byte on
};

class Pyramid {
 public:
  /// `bgr` CV_8UC3, not to be changed afterwards; `size` in metres.
  Pyramid(const cv::Mat& bgr, Eigen::Vector2f size);

  /// Of the finest level.
  cv::Size finest() const { return finest_; }
  int level_count() const { return 2 * octave_count_ - 1; }
  /// `number` from 0, the finest, to below level_count(). From any thread.
  const PyramidLevel& level(int number) const {
    const PyramidLevel* made =
        made_[static_cast<std::size_t>(number)].load(std::memory_order_acquire);
    return made ? *made : make_level(number);
  }

 private:
  static constexpr int kMaxOctaves = 16;

  const PyramidLevel& make_level(int number) const;
  const cv::Mat& octave(int number) const;

  const Eigen::Vector2f size_;
  const cv::Size finest_;
  const int octave_count_;  // the last one has a single texel
  mutable std::mutex mutex_;
  mutable cv::Mat bgr_;                   // until the first octave is made
  mutable std::vector<cv::Mat> octaves_;  // those made so far
  mutable std::array<std::unique_ptr<const PyramidLevel>, 2 * kMaxOctaves> levels_;
  mutable std::array<std::atomic<const PyramidLevel*>, 2 * kMaxOctaves> made_{};
};

}  // namespace stillpoint::simulation
