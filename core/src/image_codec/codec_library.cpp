#include <opencv2/imgcodecs.hpp>

#include "codec_functions.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {
namespace {

cv::Mat decode(std::span<const std::uint8_t> file, int imread_flags) {
  // A view; OpenCV only reads it.
  const cv::Mat bytes(1, static_cast<int>(file.size()), CV_8UC1,
                      const_cast<std::uint8_t*>(file.data()));
  return cv::imdecode(bytes, imread_flags);
}

std::vector<std::uint8_t> encode(const std::string& extension, const cv::Mat& image,
                                 const std::vector<int>& imwrite_options) {
  std::vector<std::uint8_t> file;
  if (!cv::imencode(extension, image, file, imwrite_options)) file.clear();
  return file;
}

}  // namespace
}  // namespace stillpoint

/// Also makes OpenCV's list of formats, which would be destroyed first of all if it were made
/// later.
extern "C" STILLPOINT_EXPORT const stillpoint::CodecFunctions* stillpoint_image_codec() {
  static const stillpoint::CodecFunctions functions{&stillpoint::decode, &stillpoint::encode};
  cv::haveImageWriter(".png");
  return &functions;
}
