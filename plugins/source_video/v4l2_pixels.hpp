// Images as devices of V4L2 send them.
#pragma once

#include <opencv2/core/mat.hpp>

#include "source_video/v4l2_device.hpp"

namespace stillpoint::source_video {

/// CV_8UC3 in BGR order, of V4L2_PIX_FMT_MJPEG or V4L2_PIX_FMT_YUYV; empty when the image is
/// incomplete or damaged.
cv::Mat bgr_of(const V4l2Image& image, std::uint32_t pixels, cv::Size size);

/// CV_16UC1 as it is, of V4L2_PIX_FMT_Z16 or V4L2_PIX_FMT_Y16; empty when it is incomplete.
cv::Mat depth_of(const V4l2Image& image, cv::Size size);

}  // namespace stillpoint::source_video
