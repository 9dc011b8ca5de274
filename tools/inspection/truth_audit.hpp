// How much of a recording its ground truth covers.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "tum_recording/recording.hpp"

namespace stillpoint::inspection {

using tum_recording::ImagePair;

struct TruthAudit {
  std::size_t poses = 0;           ///< usable lines
  std::size_t unusable_lines = 0;  ///< not finite, or not eight numbers
  std::string first_unusable;      ///< file:line
  double covered = 0.0;            ///< share of the pairs with a pose within 20 ms
  double begin = 0.0, end = 0.0;   ///< seconds, of the usable poses
};

/// Reads a TUM trajectory; unusable lines are counted, not fatal.
TruthAudit audit_truth(const std::filesystem::path& file, const std::vector<ImagePair>& pairs);

}  // namespace stillpoint::inspection
