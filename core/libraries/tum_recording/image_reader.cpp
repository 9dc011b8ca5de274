#include "tum_recording/image_reader.hpp"

#include <cstdio>
#include <memory>
#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint::tum_recording {
namespace {

constexpr std::uintmax_t kLargestFile = 256 << 20;  // bytes

[[noreturn]] void cannot_load(const std::filesystem::path& file, const std::string& problem) {
  throw Error(Fault::kData, problem, file.string());
}

}  // namespace

void ImageReader::load(const std::filesystem::path& file) {
  std::error_code error;
  // A pipe would be waited for.
  if (std::filesystem::exists(file, error) && !std::filesystem::is_regular_file(file, error))
    cannot_load(file, "is no regular file");
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(
      std::fopen(file.c_str(), "rb"), [](std::FILE* f) { return std::fclose(f); });
  if (!stream)
    cannot_load(file, std::filesystem::exists(file, error) ? "cannot be opened" : "no such file");
  const auto size = std::filesystem::file_size(file, error);
  if (error) cannot_load(file, "cannot be read: " + error.message());
  if (size == 0) cannot_load(file, "the file is empty");
  if (size > kLargestFile) cannot_load(file, "is larger than 256 MiB: no image of a camera");
  bytes_.resize(size);
  if (std::fread(bytes_.data(), 1, size, stream.get()) != size) cannot_load(file, "cannot be read");
}

cv::Mat ImageReader::color(const std::filesystem::path& file) {
  load(file);
  return decoder_.color(bytes_, file.string());
}

cv::Mat ImageReader::depth(const std::filesystem::path& file) {
  load(file);
  return decoder_.depth(bytes_, file.string());
}

}  // namespace stillpoint::tum_recording
