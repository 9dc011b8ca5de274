// The size of an image, as messages give it.
#pragma once

#include <opencv2/core/types.hpp>
#include <string>

namespace stillpoint {

/// Width and height, "640 x 480".
inline std::string size_text(cv::Size size) {
  return std::to_string(size.width) + " x " + std::to_string(size.height);
}

}  // namespace stillpoint
