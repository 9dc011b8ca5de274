// Everything `stillpoint inspect` finds out about a recording.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "inspection/depth_statistics.hpp"
#include "inspection/stream_audit.hpp"
#include "inspection/time_offset.hpp"
#include "inspection/truth_audit.hpp"
#include "stillpoint/contracts/camera.hpp"
#include "tum_recording/recording.hpp"

namespace stillpoint::inspection {

using tum_recording::Recording;
using tum_recording::RecordingOptions;

struct AuditOptions {
  RecordingOptions pairing;
  std::optional<CameraModel> camera;  ///< to compare image sizes and scale depth with
  int samples = 200;                  ///< pairs whose images are read
};

struct RecordingAudit {
  Recording recording;
  std::optional<CameraModel> camera;
  double depth_factor = 5000.0;  ///< the camera's, or the benchmark's
  StreamAudit color, depth, pairs;
  double mean_difference = 0.0;            ///< seconds between colour and depth of a pair
  double max_difference = 0.0;             ///< seconds
  std::size_t sampled = 0;                 ///< pairs whose images were read
  std::map<std::string, int> color_kinds;  ///< "640 x 480, 8 bit, 3 channels, jpg" → how many
  std::map<std::string, int> depth_kinds;
  std::vector<std::string> unreadable;  ///< of the sampled images: file and reason
  int dark_images = 0;                  ///< of the sampled ones
  int overexposed_images = 0;           ///< of the sampled ones: a third or more is white
  DepthStatistics depth_values;
  TimeOffset time_offset;
  std::optional<TruthAudit> truth;
  std::vector<std::string> warnings;  ///< what a user should know or do, most important first
};

/// Throws Error(kData) when the lists cannot be used; bad images are findings.
RecordingAudit audit_recording(const std::filesystem::path& folder, const AuditOptions& options);

}  // namespace stillpoint::inspection
