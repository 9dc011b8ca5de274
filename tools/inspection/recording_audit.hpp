// Everything `stillpoint inspect` finds out about a recording in a folder.
#pragma once

#include <filesystem>
#include <optional>

#include "inspection/pair_audit.hpp"
#include "inspection/truth_audit.hpp"
#include "tum_recording/recording.hpp"

namespace stillpoint::inspection {

using tum_recording::Recording;
using tum_recording::RecordingOptions;

struct AuditOptions {
  RecordingOptions pairing;
  std::optional<CameraModel> camera;  ///< to compare image sizes and scale depth with
  int samples = 200;                  ///< pairs whose images are read
};

struct RecordingAudit : PairAudit {
  Recording recording;
  std::optional<TruthAudit> truth;
};

/// Throws Error(kData) when the lists cannot be used; bad images are findings.
RecordingAudit audit_recording(const std::filesystem::path& folder, const AuditOptions& options);

}  // namespace stillpoint::inspection
