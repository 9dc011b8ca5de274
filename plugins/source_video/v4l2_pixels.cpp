#include "source_video/v4l2_pixels.hpp"

#include <linux/videodev2.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <span>

#include "stillpoint/support/image_codec.hpp"
#include "tum_recording/image_decoder.hpp"

namespace stillpoint::source_video {
namespace {

/// In the device's buffer; some drivers do not say how long a row is.
cv::Mat rows_of(const V4l2Image& image, int type, cv::Size size) {
  const std::size_t row = static_cast<std::size_t>(size.width) * CV_ELEM_SIZE(type);
  const std::size_t stride = std::max(image.stride, row);
  if (image.bytes.size() < stride * static_cast<std::size_t>(size.height - 1) + row) return {};
  return {size, type, const_cast<std::uint8_t*>(image.bytes.data()), stride};
}

/// Without the zeros that drivers fill their buffers up with.
std::span<const std::uint8_t> without_padding(std::span<const std::uint8_t> bytes) {
  while (!bytes.empty() && bytes.back() == 0) bytes = bytes.first(bytes.size() - 1);
  return bytes;
}

cv::Mat decoded(const V4l2Image& image) {
  if (tum_recording::is_truncated_jpeg(without_padding(image.bytes))) return {};
  try {
    return decode_image(image.bytes);
  } catch (const cv::Exception&) {
    return {};
  }
}

}  // namespace

cv::Mat bgr_of(const V4l2Image& image, std::uint32_t pixels, cv::Size size) {
  cv::Mat bgr;
  if (pixels == V4L2_PIX_FMT_MJPEG) {
    bgr = decoded(image);
    return bgr.size() == size ? bgr : cv::Mat();
  }
  const cv::Mat yuyv = rows_of(image, CV_8UC2, size);
  if (!yuyv.empty()) cv::cvtColor(yuyv, bgr, cv::COLOR_YUV2BGR_YUYV);
  return bgr;
}

cv::Mat depth_of(const V4l2Image& image, cv::Size size) {
  return rows_of(image, CV_16UC1, size).clone();
}

}  // namespace stillpoint::source_video
