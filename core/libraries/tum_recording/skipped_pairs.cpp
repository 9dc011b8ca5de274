#include "tum_recording/skipped_pairs.hpp"

#include <algorithm>

namespace stillpoint::tum_recording {
namespace {

constexpr std::size_t kMaxUnusableAtStart = 10;  // unusable pairs before the first usable one
constexpr std::size_t kMaxReportedImages = 20;

}  // namespace

void SkippedPairs::warn(const std::string& warning) {
  log_(LogLevel::kWarning, warning);
  report_.warnings.push_back(warning);
}

std::optional<Frame> SkippedPairs::load_or_skip(const std::function<Frame()>& load,
                                                std::uint32_t index) {
  try {
    Frame frame = load();
    frame.index = index;
    return frame;
  } catch (const Error& reason) {
    if (reason.fault() != Fault::kData) throw;
    add(reason, index == 0);
    return std::nullopt;
  }
}

void SkippedPairs::add(const Error& reason, bool none_before) {
  ++report_.skipped;
  const bool hopeless = none_before && report_.skipped >= std::min(kMaxUnusableAtStart, total_);
  if (hopeless || 2 * report_.skipped > total_)
    throw Error(
        Fault::kData,
        (hopeless
             ? "none of the first " + std::to_string(report_.skipped) + " image pairs can be used"
             : "more than half of the " + std::to_string(total_) + " image pairs cannot be used") +
            "; the last one: " + reason.what(),
        recording_);
  const std::string warning = std::string("skipped: ") + reason.what();
  log_(LogLevel::kWarning, warning);
  if (report_.skipped <= kMaxReportedImages) report_.warnings.push_back(warning);
  if (report_.skipped == kMaxReportedImages + 1)
    report_.warnings.push_back("more images were skipped; the log names them");
}

}  // namespace stillpoint::tum_recording
