// Simulates the errors of a segmentation network on true labels.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>

#include "stillpoint/options.hpp"

namespace stillpoint::segmenter_label_images {

struct NetworkErrorOptions {
  double miss_rate = 0.0;              ///< probability that an object is missed
  int boundary = 0;                    ///< px outwards (or inwards, < 0) that outlines lie off
  double outline_error = 0.0;          ///< px up to which outlines lie off at random
  double missing_lower_part = 0.0;     ///< share of an object's height that its lower end lacks
  int holes = 0;                       ///< in each object
  double floor = 0.0;                  ///< widths of the object: floor labelled as the object
  double false_objects = 0.0;          ///< probability of a false object
  std::string false_class = "person";  ///< what it is taken for
  int error_frames = 1;                ///< frames that misses, false objects and blobs last

  void visit(OptionVisitor& visitor);
};

/// Errors depend on the seed and on the frame alone, not on earlier calls.
class NetworkErrors {
 public:
  NetworkErrors(NetworkErrorOptions options, int false_label, std::uint64_t seed)
      : options_(std::move(options)), false_label_(false_label), seed_(seed) {}

  /// Frames with the same number share misses, false objects and blobs.
  std::uint32_t period_of(std::uint32_t frame) const {
    return frame / static_cast<std::uint32_t>(options_.error_frames);
  }
  bool any() const {
    return options_.miss_rate > 0 || options_.boundary != 0 || options_.outline_error > 0 ||
           options_.missing_lower_part > 0 || options_.holes > 0 || options_.floor > 0 ||
           options_.false_objects > 0;
  }
  /// Objects are the connected parts of each class; those below `min_object_pixels` are left out.
  cv::Mat apply(const cv::Mat& labels, std::uint32_t frame, int min_object_pixels) const;

 private:
  cv::Mat outline_shift(cv::Size size, std::uint32_t frame) const;
  void degrade(cv::Mat& mask, const cv::Rect& box, cv::RNG& random) const;
  void add_false_object(cv::Mat& labels, std::uint32_t period) const;

  NetworkErrorOptions options_;
  int false_label_;
  std::uint64_t seed_;
};

}  // namespace stillpoint::segmenter_label_images
