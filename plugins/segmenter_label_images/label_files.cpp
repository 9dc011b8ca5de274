#include "segmenter_label_images/label_files.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"

namespace stillpoint::segmenter_label_images {
namespace {

namespace fs = std::filesystem;

constexpr int kVoid = 255;

std::optional<double> stamp_of(const fs::path& file) {
  const std::string text = file.stem().string();
  double time = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), time);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(time)) return {};
  return time;
}

std::string kind_of(const cv::Mat& image) {
  const std::string bits = std::to_string(8 * image.elemSize1()) + "-bit";
  return image.channels() == 1 ? bits + " gray" : bits + " colour";
}

}  // namespace

LabelFiles::LabelFiles(const fs::path& folder) {
  std::error_code error;
  fs::directory_iterator files(folder, error);
  if (error)
    throw Error(Fault::kData, "cannot read the folder of label images (" + error.message() + ")",
                folder.string(), "name it as 'path' of the segmenter");
  for (const fs::directory_entry& entry : files) {
    if (entry.path().extension() != ".png") continue;
    if (const auto time = stamp_of(entry.path())) entries_.push_back({*time, entry.path()});
  }
  if (entries_.empty())
    throw Error(Fault::kData, "the folder has no label images", folder.string(),
                "expected PNG files named by the time stamp of the colour image, such as "
                "1305031102.175304.png");
  std::ranges::sort(entries_, {}, &Entry::time);
}

const LabelFiles::Entry& LabelFiles::nearest(double time) const {
  const auto after = std::ranges::lower_bound(entries_, time, {}, &Entry::time);
  if (after == entries_.begin()) return *after;
  const auto before = after - 1;
  return after == entries_.end() || time - before->time <= after->time - time ? *before : *after;
}

cv::Mat read_labels(const fs::path& file, std::size_t classes) {
  cv::Mat labels;
  try {
    labels = decode_image(read_image_file(file), cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {
    labels.release();  // what a damaged file can make the decoder throw
  }
  if (labels.empty())
    throw Error(Fault::kData, "the label image cannot be read", file.string(),
                "is it missing, truncated or no PNG?");
  if (labels.type() != CV_8UC1)
    throw Error(Fault::kData, "the label image is " + kind_of(labels), file.string(),
                "expected one class id per pixel in 8-bit gray, without a palette");
  labels.setTo(0, labels == kVoid);
  double highest = 0;
  cv::minMaxLoc(labels, nullptr, &highest);
  if (static_cast<std::size_t>(highest) >= classes)
    throw Error(Fault::kData,
                "the label image has class id " + std::to_string(static_cast<int>(highest)) +
                    ", but there are " + std::to_string(classes) + " classes",
                file.string(), "give the list that the ids belong to as 'classes'");
  return labels;
}

}  // namespace stillpoint::segmenter_label_images
