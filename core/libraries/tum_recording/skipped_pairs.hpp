// Pairs that cannot be used: they are left out and reported, until too few are left.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>

#include "stillpoint/contracts/source.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/plugin.hpp"

namespace stillpoint::tum_recording {

class SkippedPairs {
 public:
  using Log = std::function<void(LogLevel, std::string_view)>;

  /// `total`: pairs there are.
  SkippedPairs(std::size_t total, std::string recording, Log log)
      : total_(total), recording_(std::move(recording)), log_(std::move(log)) {}

  /// Something to report that leaves out nothing.
  void warn(const std::string& warning);
  /// What `load` gives, as frame `index`; nothing when it throws Error(kData): the pair is left
  /// out. Throws Error(kData) when the first ten are all unusable, or more than half.
  std::optional<Frame> load_or_skip(const std::function<Frame()>& load, std::uint32_t index);

  const SourceReport& report() const { return report_; }

 private:
  void add(const Error& reason, bool none_before);

  std::size_t total_;
  std::string recording_;
  Log log_;
  SourceReport report_;
};

}  // namespace stillpoint::tum_recording
