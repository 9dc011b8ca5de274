// The pixels of sensor_msgs/Image.
#pragma once

#include <sensor_msgs/Image.h>

#include <opencv2/core/mat.hpp>

namespace stillpoint_ros {

/// CV_8UC3 in BGR order, of bgr8, rgb8, bgra8, rgba8 and mono8. Throws stillpoint::Error(kData)
/// for another encoding, or when the bytes do not fit the size.
cv::Mat color_pixels(const sensor_msgs::Image& image);

/// CV_16UC1 as sent, of 16UC1 and mono16, or CV_32FC1 in metres, of 32FC1. Throws as above.
cv::Mat depth_pixels(const sensor_msgs::Image& image);

}  // namespace stillpoint_ros
