// The failure of a stage, in words that outlive the stage.
#pragma once

#include <atomic>
#include <cstdint>
#include <exception>
#include <optional>
#include <string>

#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint {

/// "segmentation (opencv_dnn) failed on frame 412: …". The fault is kStage, except that unusable
/// data stay kData.
class STILLPOINT_EXPORT StageError final : public Error {
 public:
  StageError(const std::string& stage, std::optional<std::uint32_t> frame,
             const std::exception* cause);
};

/// Calls `function`; whatever it throws leaves as StageError, and where there is a StageGuard also
/// what ends it otherwise: then `usable`, if given, becomes false (EndedCall). An exception object
/// of a plugin never travels further than its stage.
template <class Function>
auto in_stage(const std::string& stage, std::optional<std::uint32_t> frame, Function&& function,
              std::atomic<bool>* usable = nullptr) -> decltype(function()) {
  try {
    return call_guarded(stage, frame, function);
  } catch (const StageError&) {  // of a stage that this one called
    throw;
  } catch (const EndedCall& ended) {
    if (usable) *usable = false;
    if (!ended.thread().empty()) throw StageError(ended.thread(), std::nullopt, &ended);
    throw StageError(stage, frame, &ended);
  } catch (const std::exception& error) {
    throw StageError(stage, frame, &error);
  } catch (...) {
    throw StageError(stage, frame, nullptr);
  }
}

}  // namespace stillpoint
