// A picture of an evaluation: both paths from above and along each axis, and the error over time.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>

#include "evaluation/evaluation.hpp"

namespace stillpoint::evaluation {

/// CV_8UC3. The estimate is shown as the SE(3) alignment places it.
cv::Mat draw_plot(const Evaluation& evaluation);

/// Throws Error(kUsage) when the file cannot be written.
void write_plot(const Evaluation& evaluation, const std::filesystem::path& png);

}  // namespace stillpoint::evaluation
