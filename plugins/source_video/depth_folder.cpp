#include "source_video/depth_folder.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string>
#include <utility>

#include "stillpoint/error.hpp"
#include "stillpoint/support/size_text.hpp"
#include "tum_recording/stamp_list.hpp"

namespace stillpoint::source_video {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> images_in(const fs::path& folder) {
  if (!fs::is_directory(folder))
    throw Error(Fault::kData, "there is no such folder", folder.string(),
                "the option 'depth' says what it is called in the recording's folder");
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder))
    if (entry.path().extension() == ".png") files.push_back(entry.path());
  if (files.empty())
    throw Error(Fault::kData, "there is no .png in this folder", folder.string(),
                "depth images are 16-bit PNGs");
  return files;
}

double time_of(const fs::path& file) {
  const auto time = tum_recording::parse_number(file.stem().string());
  if (time) return *time;
  throw Error(Fault::kData, "the name is no time in seconds", file.string(),
              "rename the images, or set pair_by: index");
}

}  // namespace

DepthFolder::DepthFolder(fs::path folder, PairBy pair_by)
    : folder_(std::move(folder)), files_(images_in(folder_)) {
  if (pair_by == PairBy::kIndex) {
    std::ranges::sort(files_);
    return;
  }
  std::ranges::sort(files_, {}, time_of);
  std::ranges::transform(files_, std::back_inserter(times_), time_of);
}

std::optional<std::size_t> DepthFolder::near(double time, std::optional<double> next,
                                             double max_difference) {
  const auto first = times_.begin() + static_cast<std::ptrdiff_t>(next_);
  const auto distance = [&](double other) { return std::abs(other - time); };
  const auto later = std::lower_bound(first, times_.end(), time);
  const auto end = later == times_.end() ? later : later + 1;
  const auto closest =
      std::ranges::min_element(later == first ? later : later - 1, end, {}, distance);
  if (closest == end || distance(*closest) > max_difference) return std::nullopt;
  if (next && std::abs(*closest - *next) < distance(*closest)) return std::nullopt;
  next_ = static_cast<std::size_t>(closest - times_.begin()) + 1;
  return next_ - 1;
}

cv::Mat DepthFolder::read(std::size_t number, cv::Size size) {
  const fs::path& file = files_[number];
  cv::Mat depth = reader_.depth(file);
  if (depth.size() != size)
    throw Error(Fault::kData,
                "the image has " + size_text(depth.size()) + " pixels, but the camera has " +
                    size_text(size),
                file.string(),
                "depth must be registered to colour, and the camera be that of both");
  return depth;
}

}  // namespace stillpoint::source_video
