#include "simulation/png_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "stillpoint/error.hpp"
#include "support/image_io.hpp"

namespace stillpoint::simulation {
namespace {

/// What another reader, OpenCV's, makes of it.
TEST(PngFile, ReadsAsItWasWritten) {
  const std::string file = ::testing::TempDir() + "png_file_test.png";
  for (const int type : {CV_8UC1, CV_8UC3, CV_16UC1}) {
    cv::Mat image(37, 53, type);
    cv::randu(image, 0, type == CV_16UC1 ? 65536 : 256);
    write_png(file, image);
    const cv::Mat read = testing::read_image(file, cv::IMREAD_UNCHANGED);
    ASSERT_EQ(read.type(), type);
    ASSERT_EQ(read.size(), image.size());
    EXPECT_EQ(cv::norm(read.reshape(1), image.reshape(1), cv::NORM_INF), 0) << type;
  }
  std::filesystem::remove(file);
}

TEST(PngFile, SaysWhichFileCannotBeWritten) {
  try {
    write_png("/dev/null/picture.png", cv::Mat::zeros(2, 2, CV_8U));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), Fault::kUsage);
    EXPECT_THAT(error.what(), ::testing::HasSubstr("/dev/null/picture.png"));
  }
}

}  // namespace
}  // namespace stillpoint::simulation
