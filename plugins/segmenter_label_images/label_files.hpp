// A folder of label images that are named by time stamp.
#pragma once

#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <vector>

namespace stillpoint::segmenter_label_images {

/// PNG files named SECONDS.png, as in `1305031102.175304.png`; others are not looked at.
class LabelFiles {
 public:
  struct Entry {
    double time = 0.0;  ///< seconds
    std::filesystem::path file;
  };

  /// Throws Error(kData) when there is no such folder or no label image in it.
  explicit LabelFiles(const std::filesystem::path& folder);

  /// In order of time.
  const std::vector<Entry>& entries() const { return entries_; }
  /// The one closest in time.
  const Entry& nearest(double time) const;

 private:
  std::vector<Entry> entries_;
};

/// One class id per pixel, CV_8UC1. 255 means "void" in such images and becomes background. Throws
/// Error(kData) naming the file when it cannot be read, is not 8-bit gray or has an id that is not
/// below `classes`.
cv::Mat read_labels(const std::filesystem::path& file, std::size_t classes);

}  // namespace stillpoint::segmenter_label_images
