// The frames of a run at which something went worst.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <vector>

namespace stillpoint::output_files {

/// How bad a frame is, the larger the worse; nothing: it is not to be looked at.
using Badness = std::function<std::optional<double>(const FrameReport&)>;

/// The most pixels are left out.
std::optional<double> exclusion(const FrameReport& report);
/// The fewest features fit the pose.
std::optional<double> lack_of_inliers(const FrameReport& report);
/// Tracking is lost, the earlier the worse.
Badness loss();

/// Keeps the worst frames, of each second of a recording at most one: neighbours look alike. Frames
/// come in order.
class WorstFrames {
 public:
  /// At most `count` frames.
  WorstFrames(std::size_t count, Badness badness) : count_(count), badness_(std::move(badness)) {}

  /// What has become one of the worst, and what is none any more in its place.
  struct Change {
    std::optional<FrameReport> in;
    std::optional<std::uint32_t> out;
  };
  Change add(const FrameReport& report);
  /// After the last frame.
  Change finish();

 private:
  struct Bad {
    double badness;
    std::uint32_t frame;
  };

  std::size_t count_;
  Badness badness_;
  double second_ = 0;  // of the frame added last
  std::optional<FrameReport> worst_of_second_;
  double badness_of_second_ = 0.0;
  std::vector<Bad> kept_;  // the worst first
};

}  // namespace stillpoint::output_files
