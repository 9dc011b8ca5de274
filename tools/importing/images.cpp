#include "importing/images.hpp"

#include <algorithm>
#include <charconv>

#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/size_text.hpp"
#include "tum_recording/image_reader.hpp"

namespace stillpoint::importing {

StoredImage kept_image(double time, const std::filesystem::path& file) {
  if (!std::filesystem::is_regular_file(file))
    throw Error(Fault::kData, "no such image", file.string());
  return {.time = time, .file = file, .extension = file.extension().string()};
}

StoredImage new_depth(double time, const cv::Mat& depth) {
  StoredImage image{.time = time};
  image.bytes = encode_image(".png", depth, {cv::IMWRITE_PNG_COMPRESSION, 3});
  return image;
}

void check_size(cv::Size size, const CameraModel& camera, const std::string& where) {
  const cv::Size expected(camera.width, camera.height);
  if (size != expected)
    throw Error(Fault::kData,
                "is " + size_text(size) + " pixels, the camera '" + camera.name + "' has " +
                    size_text(expected),
                where, "name the one of the images with --camera; depth must be registered to it");
}

void check_first_pair(const std::filesystem::path& color, const std::filesystem::path& depth,
                      const CameraModel& camera) {
  tum_recording::ImageReader reader;
  check_size(reader.color(color).size(), camera, color.string());
  check_size(reader.depth(depth).size(), camera, depth.string());
}

std::optional<std::int64_t> number_of(const std::string& word) {
  std::int64_t number = 0;
  const char* end = word.data() + word.size();
  const auto [rest, error] = std::from_chars(word.data(), end, number);
  if (error != std::errc() || number < 0 || (rest != end && *rest != '.')) return std::nullopt;
  return number;
}

std::vector<std::string> file_names(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error))
    if (entry.is_regular_file(error)) names.push_back(entry.path().filename().string());
  std::ranges::sort(names);
  return names;
}

}  // namespace stillpoint::importing
