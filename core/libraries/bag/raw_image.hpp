// The pixels of sensor_msgs/Image.
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

/// Depth in metres of what compressed_depth_image_transport makes of a 32FC1 image: 16 bits with
/// inverse depth. `header`: the 12 bytes before the PNG file.
cv::Mat metres_of_inverse_depth(const cv::Mat& quantised, ByteSpan header);

}  // namespace stillpoint::bag
