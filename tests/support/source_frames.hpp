// Small images for recordings, and the frames that a source gives of them.
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "stillpoint/contracts/source.hpp"

namespace stillpoint::testing {

constexpr int kImageWidth = 64;   // px
constexpr int kImageHeight = 48;  // px

/// Of one colour, or of one depth.
inline cv::Mat color_image(int blue) {
  return {kImageHeight, kImageWidth, CV_8UC3, cv::Scalar(blue, 100, 200)};
}
inline cv::Mat depth_image(int raw) {
  return {kImageHeight, kImageWidth, CV_16UC1, cv::Scalar(raw)};
}

/// All that are left.
inline std::vector<Frame> frames_of(Source& source) {
  std::vector<Frame> frames;
  while (auto frame = source.next()) frames.push_back(*frame);
  return frames;
}

}  // namespace stillpoint::testing
