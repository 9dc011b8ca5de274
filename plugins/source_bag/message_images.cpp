#include "source_bag/message_images.hpp"

#include "bag/raw_image.hpp"
#include "stillpoint/error.hpp"
#include "tum_recording/png_decoder.hpp"

namespace stillpoint::source_bag {
namespace {

constexpr std::size_t kDepthHeader = 12;  // bytes, of compressed_depth_image_transport

}  // namespace

cv::Mat MessageImages::color(const bag::ImageMessage& message) {
  return message.description.compressed ? decoder_.color(message.data, "")
                                        : bag::color_pixels(message);
}

cv::Mat MessageImages::depth(const bag::ImageMessage& message) {
  return message.description.compressed ? compressed_depth(message) : bag::depth_pixels(message);
}

/// A PNG file of 16 bits, most often behind a header: of 32FC1 images it is inverse depth.
cv::Mat MessageImages::compressed_depth(const bag::ImageMessage& message) {
  const bag::ByteSpan data = message.data;
  if (tum_recording::PngDecoder::is_png(data)) return decoder_.depth(data, "");
  if (data.size() < kDepthHeader || !tum_recording::PngDecoder::is_png(data.subspan(kDepthHeader)))
    throw Error(Fault::kData, "depth of the format '" + message.description.encoding +
                                  "' is read as PNG only, which this is not");
  const cv::Mat image = decoder_.depth(data.subspan(kDepthHeader), "");
  return message.description.encoding.starts_with("32FC1")
             ? bag::metres_of_inverse_depth(image, data.first(kDepthHeader))
             : image;
}

}  // namespace stillpoint::source_bag
