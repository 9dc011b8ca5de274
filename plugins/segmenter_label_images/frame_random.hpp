// Random numbers that depend on the seed and the frame alone, not on earlier calls.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>

namespace stillpoint::segmenter_label_images {

/// What random numbers are for; streams of different purposes are independent.
enum class Purpose : std::uint32_t { kMisses, kOutlines, kFalseObjects, kHoles, kBlobs };

/// `period`: the frame, or the number of the frames that share their errors.
cv::RNG frame_random(std::uint64_t seed, Purpose purpose, std::uint32_t period);

/// CV_8UC1 of this size, 255 in an ellipse somewhere that is up to half as high as the image.
cv::Mat random_blob(cv::Size size, cv::RNG& random);

}  // namespace stillpoint::segmenter_label_images
