#include "stillpoint/engine/stage_error.hpp"

namespace stillpoint {
namespace {

Fault fault_of(const std::exception* cause) {
  const auto* error = dynamic_cast<const Error*>(cause);
  return error && error->fault() == Fault::kData ? Fault::kData : Fault::kStage;
}

std::string place(const std::string& stage, std::optional<std::uint32_t> frame) {
  return stage + " failed" + (frame ? " on frame " + std::to_string(*frame) : "");
}

}  // namespace

StageError::StageError(const std::string& stage, std::optional<std::uint32_t> frame,
                       const std::exception* cause)
    : Error(fault_of(cause), cause ? cause->what() : "an exception of unknown type",
            place(stage, frame)) {}

}  // namespace stillpoint
