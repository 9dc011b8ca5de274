#include "simulation/album.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <string>

#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"

namespace stillpoint::simulation {
namespace {

namespace fs = std::filesystem;

constexpr std::uint64_t kBytesPerPixel = 3;
constexpr std::uint64_t kMostBytes = std::uint64_t{2} << 30;  // of all photographs, decoded

bool is_image(const fs::path& file) {
  static constexpr std::array<const char*, 4> kExtensions = {".jpg", ".jpeg", ".png", ".webp"};
  return std::ranges::find(kExtensions, file.extension().string()) != kExtensions.end();
}

std::vector<fs::path> images_in(const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator files(folder, error);
  std::vector<fs::path> images;
  if (!error)
    for (const fs::directory_entry& entry : files)
      if (is_image(entry.path())) images.push_back(entry.path());
  if (images.empty())
    throw Error(Fault::kUsage, "there are no photographs", folder.string(),
                "name a folder of JPEG, PNG or WebP images as room.photographs");
  std::ranges::sort(images);
  return images;
}

/// Of what the headers state, before anything is decoded.
void require_size(const fs::path& folder, const std::vector<fs::path>& files) {
  std::uint64_t bytes = 0;
  for (const fs::path& file : files)
    if (const auto size = stated_image_size(read_image_file(file)))
      bytes += kBytesPerPixel * static_cast<std::uint64_t>(size->width) * size->height;
  if (bytes > kMostBytes)
    throw Error(Fault::kUsage,
                "its photographs take " + std::to_string(bytes >> 20) + " MiB of memory",
                folder.string(),
                "choose some, or make them smaller; at most " + std::to_string(kMostBytes >> 20) +
                    " MiB are used");
}

}  // namespace

Album::Album(const fs::path& folder) {
  const std::vector<fs::path> files = images_in(folder);
  require_size(folder, files);
  for (const fs::path& file : files) {
    photographs_.push_back(decode_image(read_image_file(file), cv::IMREAD_COLOR));
    if (photographs_.back().empty())
      throw Error(Fault::kUsage, "the photograph cannot be read", file.string());
  }
}

cv::Mat Album::one(cv::Size size, cv::RNG& random) const {
  const cv::Mat& photo = photographs_[static_cast<std::size_t>(
      random.uniform(0, static_cast<int>(photographs_.size())))];
  const double scale = std::max(static_cast<double>(size.width) / photo.cols,
                                static_cast<double>(size.height) / photo.rows);
  const cv::Size part(std::min(photo.cols, cvRound(size.width / scale)),
                      std::min(photo.rows, cvRound(size.height / scale)));
  const cv::Point corner(random.uniform(0, photo.cols - part.width + 1),
                         random.uniform(0, photo.rows - part.height + 1));
  cv::Mat result;
  cv::resize(photo({corner, part}), result, size, 0, 0,
             scale > 1 ? cv::INTER_CUBIC : cv::INTER_AREA);
  if (random.uniform(0, 2) == 1) cv::flip(result, result, 1);
  return result;
}

cv::Mat Album::many(cv::Size size, int rows, cv::RNG& random) const {
  cv::Mat result(size, CV_8UC3);
  for (int row = 0; row < rows; ++row) {
    const int top = size.height * row / rows;
    const int height = size.height * (row + 1) / rows - top;
    for (int x = 0; x < size.width;) {
      int width = height * random.uniform(70, 160) / 100;
      if (size.width - x - width < height / 2)
        width = size.width - x;  // no narrow strip at the end
      one({width, height}, random).copyTo(result(cv::Rect(x, top, width, height)));
      x += width;
    }
  }
  return result;
}

}  // namespace stillpoint::simulation
