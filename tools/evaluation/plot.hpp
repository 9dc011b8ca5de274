// A picture of trajectories beside their reference: from above and along each axis, and the error
// over time.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <span>
#include <string>

#include "evaluation/evaluation.hpp"

namespace stillpoint::evaluation {

struct PlottedRun {
  std::string name;
  const Evaluation& evaluation;
  const AbsoluteError& error;  ///< with the alignment that places it in the picture
};

/// CV_8UC3, of at least one run; all have the same reference.
cv::Mat draw_plot(std::span<const PlottedRun> runs);

/// As PNG. Throws Error(kUsage) when the file cannot be written.
void write_plot(std::span<const PlottedRun> runs, const std::filesystem::path& png);

}  // namespace stillpoint::evaluation
