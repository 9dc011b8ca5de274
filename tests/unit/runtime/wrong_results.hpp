// What checks of results say, and a frame that they accept.
#pragma once

#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint {

inline const cv::Size kSize(4, 3);
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kFloatNan = std::numeric_limits<float>::quiet_NaN();

inline std::string message_of(const std::function<void()>& check) {
  try {
    check();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kStage);
    return error.what();
  }
  return "";
}

inline Frame right_frame(std::uint32_t index = 0) {
  return {.index = index,
          .time = 5.0 + index,
          .bgr = cv::Mat(kSize, CV_8UC3, cv::Scalar::all(0)),
          .gray = cv::Mat(kSize, CV_8UC1, cv::Scalar(0)),
          .depth = cv::Mat(kSize, CV_32FC1, cv::Scalar(1)),
          .camera = std::make_shared<const Camera>(Camera{.width = 4, .height = 3})};
}

}  // namespace stillpoint
