// A recording in the format of the TUM RGB-D benchmark: its lists and which images belong together.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tum_recording/stamp_list.hpp"

namespace stillpoint::tum_recording {

/// Which of a recording's descriptions to use where it has both.
enum class PairsFrom { kLists /* rgb.txt and depth.txt */, kAssociations };

struct RecordingOptions {
  double max_difference = 0.02;  ///< seconds between colour and depth of a pair; lists only
  double time_offset = 0.0;      ///< seconds added to depth stamps; lists only
  PairsFrom prefer = PairsFrom::kLists;
};

struct ImagePair {
  StampedImage color;
  StampedImage depth;  ///< its stamp includes the time offset
};

struct Recording {
  std::filesystem::path folder;
  std::filesystem::path pairs_from;    ///< the associations file, or empty: paired by time
  std::vector<StampedImage> color;     ///< in order of time, without repeated stamps
  std::vector<StampedImage> depth;     ///< likewise; stamps include the time offset
  std::vector<ImagePair> pairs;        ///< in order of colour time
  std::filesystem::path ground_truth;  ///< groundtruth.txt, or empty when there is none
  std::vector<std::string> warnings;   ///< one line each
};

/// Reads lists only, no images. Throws Error(kData) naming file and line.
Recording open_recording(const std::filesystem::path& folder, const RecordingOptions& options = {});

}  // namespace stillpoint::tum_recording
