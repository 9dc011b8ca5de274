// Contract: where frames come from. A thread of its own when threaded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "stillpoint/contracts/frame.hpp"

namespace stillpoint {

/// What a source left out, for the summary.
struct SourceReport {
  std::size_t skipped = 0;            ///< images that could not be used, or came too fast
  std::vector<std::string> warnings;  ///< one line each
};

/// Gives the frames of a recording. next() is called on a thread of its own in `mode: threaded` and
/// with `pace: sensor`, up to three frames ahead of tracking, otherwise on thread 1.
class STILLPOINT_EXPORT Source {
 public:
  static constexpr const char* kKind = "source";
  static constexpr std::uint32_t kApi = 2;  ///< see kPluginApi
  virtual ~Source();

  /// Once, before the first next(), on thread 1. A stop is requested of the token when the run is
  /// stopped: a source that waits for a camera or a network then ends its wait within half a
  /// second, and next() gives nothing. Sources that read files need not look.
  virtual void begin(std::stop_token) {}

  /// The next frame in order of time, or nothing at the end, and nothing again after it. Indices
  /// count up from 0 without gaps. The images are the pipeline's from then on: they must not
  /// change, nor their memory be used again. Throws Error(kData) when the recording cannot be used
  /// any further.
  virtual std::optional<Frame> next() = 0;

  /// Frames to expect, for progress; nothing when not known. Asked once, before the first frame.
  virtual std::optional<std::size_t> size() const { return std::nullopt; }

  /// Images left out so far, for those who watch the run: SourceReport::skipped, as far as it is
  /// known. Asked after each next(), on its thread.
  virtual std::size_t left_out() const { return 0; }

  /// Asked once, after the last frame, on thread 1.
  virtual SourceReport report() const { return {}; }

  /// TUM-format file of true poses, if the source has one; for the hint at the end of a run.
  virtual std::filesystem::path ground_truth() const { return {}; }
};

}  // namespace stillpoint
