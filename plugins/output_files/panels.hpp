// The rows of the paper's Fig. 5 of one frame, as one picture.
#pragma once

#include <opencv2/core/mat.hpp>
#include <stillpoint/sdk.hpp>

namespace stillpoint::output_files {

/// Four pictures of the frame's size, CV_8UC3: features and moving points above, labels with what
/// was decided of each object and what tracking uses below.
cv::Mat panels_of(const FrameReport& report);

}  // namespace stillpoint::output_files
