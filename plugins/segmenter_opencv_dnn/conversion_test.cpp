// The shipped network is what tools/convert_model makes of the published file, byte by byte.
#include <gtest/gtest.h>

#include <cstdlib>

#include "segmenter_opencv_dnn/test_networks.hpp"

namespace stillpoint {
namespace {

int convert(const std::filesystem::path& from, const std::filesystem::path& to) {
  const std::string command = "'" STILLPOINT_SOURCE_DIR "/tools/convert_model' '" + from.string() +
                              "' '" + to.string() + "'";
  return std::system(command.c_str());
}

TEST(Conversion, IsReproducible) {
  const testing::TemporaryFolder folder;
  const auto published =
      std::filesystem::path(STILLPOINT_SOURCE_DIR) /
      "plugins/segmenter_opencv_dnn/test_data/selfie_segmentation_landscape.tflite";
  ASSERT_EQ(convert(published, folder.path() / "net.onnx"), 0);
  EXPECT_EQ(read_file(folder.path() / "net.onnx"), read_file(shipped_model()));
}

TEST(Conversion, RefusesOtherFiles) {
  const testing::TemporaryFolder folder;
  ::testing::internal::CaptureStderr();
  EXPECT_NE(convert(folder.write("text.tflite", "this is text"), folder.path() / "net.onnx"), 0);
  EXPECT_NE(convert(folder.write("cut.tflite", std::string("\x1c\0\0\0TFL3", 8)),
                    folder.path() / "net.onnx"),
            0);
  const std::string message = ::testing::internal::GetCapturedStderr();
  EXPECT_NE(message.find("this is no TensorFlow Lite file"), std::string::npos) << message;
  EXPECT_NE(message.find("truncated or damaged"), std::string::npos) << message;
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "net.onnx"));
}

}  // namespace
}  // namespace stillpoint
