// The failure of a stage, in words that outlive the stage.
#pragma once

#include <cstdint>
#include <exception>
#include <optional>
#include <string>
#include <utility>

#include "stillpoint/error.hpp"

namespace stillpoint {

/// "segmentation (opencv_dnn) failed on frame 412: …". The fault is kStage, except that unusable
/// data stay kData.
class StageError final : public Error {
 public:
  StageError(const std::string& stage, std::optional<std::uint32_t> frame,
             const std::exception* cause);
};

/// Calls `function`; whatever it throws leaves as StageError. An exception object of a plugin never
/// travels further than its stage.
template <class Function>
auto in_stage(const std::string& stage, std::optional<std::uint32_t> frame, Function&& function)
    -> decltype(function()) {
  try {
    return std::forward<Function>(function)();
  } catch (const StageError&) {  // of a stage that this one called
    throw;
  } catch (const std::exception& error) {
    throw StageError(stage, frame, &error);
  } catch (...) {
    throw StageError(stage, frame, nullptr);
  }
}

}  // namespace stillpoint
