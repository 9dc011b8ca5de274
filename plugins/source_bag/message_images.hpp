// The images of messages, as frames are made of them.
#pragma once

#include <opencv2/core/mat.hpp>
#include <string>

#include "bag/messages.hpp"
#include "tum_recording/image_decoder.hpp"

namespace stillpoint::source_bag {

/// Throws Error(kData) when an image is damaged or of a kind that is not read. One per thread.
class MessageImages {
 public:
  /// CV_8UC3 in BGR order.
  cv::Mat color(const bag::ImageMessage& message);
  /// CV_16UC1 as recorded, or CV_32FC1 in metres.
  cv::Mat depth(const bag::ImageMessage& message);

 private:
  cv::Mat compressed_depth(const bag::ImageMessage& message);

  tum_recording::ImageDecoder decoder_;
};

}  // namespace stillpoint::source_bag
