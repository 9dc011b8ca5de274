// The shipped network is what tools/convert_model makes of the published file, byte by byte.
#include <gtest/gtest.h>

#include <cstdlib>

#include "segmenter_opencv_dnn/test_networks.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

namespace fs = std::filesystem;

fs::path test_data() { return STILLPOINT_SOURCE_DIR "/plugins/segmenter_opencv_dnn/test_data"; }

int convert(const fs::path& from, const fs::path& to, const std::string& options = {}) {
  const std::string command = "'" STILLPOINT_SOURCE_DIR "/tools/convert_model' '" + from.string() +
                              "' '" + to.string() + "' " + options;
  return std::system(command.c_str());
}

TEST(Conversion, IsReproducible) {
  const testing::TemporaryFolder folder;
  ASSERT_EQ(
      convert(test_data() / "selfie_segmentation_landscape.tflite", folder.path() / "net.onnx"), 0);
  EXPECT_EQ(read_file(folder.path() / "net.onnx"), read_file(shipped_model()));
}

// A random network with 8-bit weights and activations, as the larger published ones have them, for
// another input size; quantised.onnx was made by an independent converter.
TEST(Conversion, DequantisesAndResizes) {
  const testing::TemporaryFolder folder;
  ASSERT_EQ(convert(test_data() / "quantised.tflite", folder.path() / "net.onnx",
                    "--size 385x513 --opset 9 --skip-padding --output float_seg=segments "
                    "--output float_parts=part_heatmaps --output float_heat=heatmaps "
                    "--comment 'a quantised network'"),
            0);
  EXPECT_EQ(read_file(folder.path() / "net.onnx"), read_file(test_data() / "quantised.onnx"));
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
}  // namespace stillpoint::segmenter_opencv_dnn
