#include "tum_recording/image_reader.hpp"

#include "stillpoint/support/image_file.hpp"

namespace stillpoint::tum_recording {

cv::Mat ImageReader::color(const std::filesystem::path& file) {
  read_image_file(file, bytes_);
  return decoder_.color(bytes_, file.string());
}

cv::Mat ImageReader::depth(const std::filesystem::path& file) {
  read_image_file(file, bytes_);
  return decoder_.depth(bytes_, file.string());
}

}  // namespace stillpoint::tum_recording
