// A folder of depth images, and which of them belongs to which image of a video.
#pragma once

#include <cstddef>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "tum_recording/image_reader.hpp"

namespace stillpoint::source_video {

/// What says that a depth image and an image of the video are of the same moment.
enum class PairBy {
  kIndex,  ///< the i-th name in the order of the names
  kTime    ///< names are times in seconds
};

class DepthFolder {
 public:
  /// Throws Error(kData) when there is no such folder, it has no PNG, or names are no times.
  DepthFolder(std::filesystem::path folder, PairBy pair_by);

  const std::filesystem::path& path() const { return folder_; }
  std::size_t size() const { return files_.size(); }
  /// The closest one that is at most so far away and that no earlier call gave, unless it is closer
  /// to `next`, the time of the next call, if there is one. Times must grow.
  std::optional<std::size_t> near(double time, std::optional<double> next, double max_difference);
  /// CV_16UC1 of this size. Throws Error(kData) for any other image, and for one that is damaged.
  cv::Mat read(std::size_t number, cv::Size size);

 private:
  std::filesystem::path folder_;
  std::vector<std::filesystem::path> files_;
  std::vector<double> times_;  // s, of files_; with kTime
  std::size_t next_ = 0;       // first one that near() has not given
  tum_recording::ImageReader reader_;
};

}  // namespace stillpoint::source_video
