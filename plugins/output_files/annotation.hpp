// Draws the results of the pipeline on a frame.
#pragma once

#include <opencv2/core/mat.hpp>
#include <stillpoint/sdk.hpp>

namespace stillpoint::output_files {

/// What is drawn.
struct AnnotationParts {
  bool features = true;
  bool moving = true;
  bool mask = true;
  bool evidence = false;  ///< of the map check
  bool text = true;
};

/// A picture of the frame's size, CV_8UC3.
cv::Mat annotated(const FrameReport& report, const AnnotationParts& parts);

}  // namespace stillpoint::output_files
