#include "simulation/album.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "simulation/simulator.hpp"
#include "small_camera.hpp"
#include "stillpoint/error.hpp"
#include "support/error_text.hpp"
#include "support/image_io.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::simulation {
namespace {

class AlbumTest : public ::testing::Test {
 protected:
  AlbumTest() {
    testing::write_image(folder_.path() / "a.png", cv::Mat(30, 60, CV_8UC3, cv::Scalar(0, 200, 0)));
    testing::write_image(folder_.path() / "b.png", cv::Mat(60, 30, CV_8UC3, cv::Scalar(0, 120, 0)));
    folder_.write("list.txt", "no image");
  }
  static double green(const cv::Mat& bgr) {
    std::vector<cv::Mat> channels;
    cv::split(bgr, channels);
    return cv::countNonZero(channels[1] > channels[2] + 40) / static_cast<double>(bgr.total());
  }
  testing::TemporaryFolder folder_;
};

TEST_F(AlbumTest, PhotographsFillWhatIsAskedFor) {
  const Album album(folder_.path());
  cv::RNG random(1);
  EXPECT_EQ(green(album.one({40, 70}, random)), 1);
  const cv::Mat many = album.many({500, 90}, 3, random);
  EXPECT_EQ(many.size(), cv::Size(500, 90));
  EXPECT_EQ(green(many), 1);
}

TEST_F(AlbumTest, AFolderWithoutPhotographsIsRefused) {
  std::filesystem::remove(folder_.path() / "a.png");
  std::filesystem::remove(folder_.path() / "b.png");
  EXPECT_THROW(Album{folder_.path()}, Error);
  folder_.write("c.png", "damaged");
  EXPECT_THROW(Album{folder_.path()}, Error);
}

TEST_F(AlbumTest, MorePhotographsThanMemoryAreRefusedBeforeTheyAreDecoded) {
  // The header of a PNG file of 10,000 x 10,000 pixels, without pixels.
  const std::string header(
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\x27\x10\0\0\x27\x10\x08\2\0\0\0\0\0\0\0", 33);
  for (int i = 0; i < 8; ++i) folder_.write("large" + std::to_string(i) + ".png", header);
  EXPECT_THAT(testing::error_text(Fault::kUsage, [&] { Album{folder_.path()}; }),
              ::testing::HasSubstr("its photographs take 2288 MiB of memory"));
}

TEST_F(AlbumTest, TheyCoverTheRoom) {
  SceneOptions scene;
  scene.frames = 1;
  scene.motion.kind = MotionOptions::Kind::kStatic;
  Simulator painted(scene, small_camera(), 1);
  scene.room.photographs = folder_.path();
  Simulator photographic(scene, small_camera(), 1);
  EXPECT_LT(green(painted.frame(0).bgr), 0.1);
  EXPECT_GT(green(photographic.frame(0).bgr), 0.6);
}

}  // namespace
}  // namespace stillpoint::simulation
