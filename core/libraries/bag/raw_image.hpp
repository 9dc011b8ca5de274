// The pixels of messages with images, but for those in files such as PNG.
#pragma once

#include <opencv2/core/mat.hpp>

#include "bag/messages.hpp"

namespace stillpoint::bag {

/// CV_8UC3 in BGR order, of colour, gray, YUV 4:2:2 and Bayer images. Throws Error(kData) when the
/// message is none of these, or its numbers do not fit its bytes.
cv::Mat color_pixels(const ImageMessage& image);

/// CV_16UC1 as recorded, in ROS millimetres, or CV_32FC1 in metres, NaN where there is none. Throws
/// Error(kData) as above.
cv::Mat depth_pixels(const ImageMessage& image);

/// What is in a compressed depth image.
struct CompressedDepth {
  ByteSpan png;             ///< of 16 bits
  ByteSpan inverse_header;  ///< of inverse depth, as metres_of_inverse_depth() takes it; or empty
};

/// A PNG file, most often behind a header of compressed_depth_image_transport, which makes inverse
/// depth of 32FC1 images. Throws Error(kData) when it is something else.
CompressedDepth compressed_depth(const ImageMessage& image);

/// CV_32FC1 in metres, 0 where there is none, of 16 bits with inverse depth.
cv::Mat metres_of_inverse_depth(const cv::Mat& quantised, ByteSpan header);

}  // namespace stillpoint::bag
