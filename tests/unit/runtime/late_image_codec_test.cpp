#include <gtest/gtest.h>

#include <cstdlib>
#include <iostream>
#include <optional>
#include <stdexcept>

#include "stillpoint/engine/stage_guard.hpp"
#include "stillpoint/support/image_codec.hpp"

namespace stillpoint {
namespace {

constexpr int kEncodedAfterwards = 7;

/// A stage ends the process; then an output writes an image.
[[noreturn]] void exit_between_two_images() {
  const StageGuard guard;
  const cv::Mat image(4, 4, CV_8UC3, cv::Scalar::all(80));
  encode_image(".png", image);
  auto stage = [] { std::exit(0); };
  try {
    call_guarded("stage", std::nullopt, stage);
  } catch (const std::runtime_error& error) {
    std::cerr << error.what() << '\n';
  }
  std::_Exit(encode_image(".png", image).empty() ? 1 : kEncodedAfterwards);
}

// std::exit() destroys first what was loaded last: the guard has to come before the codec.
TEST(LateImageCodec, IsWholeWhenAnExitIsNoticed) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // a new process, which has not loaded it yet
  EXPECT_EXIT(exit_between_two_images(), ::testing::ExitedWithCode(kEncodedAfterwards),
              "it called std::exit");
}

}  // namespace
}  // namespace stillpoint
