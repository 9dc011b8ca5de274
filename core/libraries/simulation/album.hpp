// Photographs to paint surfaces with.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <vector>

namespace stillpoint::simulation {

class Album {
 public:
  /// Every image of the folder (JPEG, PNG, WebP) in order of name. Throws Error(kUsage) when there
  /// is none, or one that cannot be read.
  explicit Album(const std::filesystem::path& folder);

  /// A photograph that `random` draws, cut to fill `size`. CV_8UC3.
  cv::Mat one(cv::Size size, cv::RNG& random) const;
  /// Many of them side by side in `rows` rows, of different widths, as posters cover a wall.
  cv::Mat many(cv::Size size, int rows, cv::RNG& random) const;

 private:
  std::vector<cv::Mat> photographs_;
};

}  // namespace stillpoint::simulation
