// How far a run has come.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>

#include "console.hpp"
#include "stillpoint/contracts/output.hpp"

namespace stillpoint {

/// On a terminal a bar with rate, remaining time and state; elsewhere a line about every five
/// seconds or ten per cent.
class Progress final : public Output {
 public:
  /// Whether there is more than frames to count.
  enum class Of { kTracking, kRecording };
  /// `frames` to expect, when known.
  Progress(Console& console, std::optional<std::size_t> frames, Of what = Of::kTracking);
  void frame(const FrameReport& report) override;
  void finish(const RunSummary&) override { console_.status(""); }

 private:
  using Clock = std::chrono::steady_clock;

  bool due(Clock::time_point now) const;
  double share() const;
  std::string describe(double seconds, const TrackResult& result) const;

  Console& console_;
  const std::optional<std::size_t> frames_;
  const Of what_;
  const Clock::time_point start_ = Clock::now();
  Clock::time_point last_shown_ = start_;
  double last_share_ = 0.0;
  std::size_t done_ = 0;  // of the recording, dropped frames included
  std::size_t processed_ = 0;
  std::size_t keyframes_ = 0;
  std::size_t left_out_ = 0;  // by the source
};

}  // namespace stillpoint
