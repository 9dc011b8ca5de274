// Contract: where frames come from. A thread of its own when threaded.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "stillpoint/contracts/frame.hpp"

namespace stillpoint {

/// What a source left out, for the summary.
struct SourceReport {
  std::size_t skipped = 0;            ///< images that could not be used
  std::vector<std::string> warnings;  ///< one line each
};

class STILLPOINT_EXPORT Source {
 public:
  static constexpr const char* kKind = "source";
  static constexpr std::uint32_t kApi = 1;  ///< see kPluginApi
  virtual ~Source();

  /// The next frame in order of time, or nothing at the end. Indices count up from 0 without gaps.
  /// Throws Error(kData) when the recording cannot be used any further.
  virtual std::optional<Frame> next() = 0;

  /// Frames to expect, for progress; nothing when not known.
  virtual std::optional<std::size_t> size() const { return std::nullopt; }

  virtual SourceReport report() const { return {}; }

  /// TUM-format file of true poses, if the source has one; for the hint at the end of a run.
  virtual std::filesystem::path ground_truth() const { return {}; }
};

}  // namespace stillpoint
