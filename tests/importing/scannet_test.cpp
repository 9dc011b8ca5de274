#include "importing/fixtures.hpp"
#include "importing/sens_file.hpp"
#include "importing/sens_writer.hpp"

namespace stillpoint::importing {
namespace {

using stillpoint::testing::SensWriter;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class ScanNetTest : public ::testing::Test {
 protected:
  void add(int count, std::uint64_t step = 33'333) {
    for (int i = 0; i < count; ++i)
      writer.images.push_back({.color = flat_color(writer.color_size),
                               .depth = flat_depth(1500 + i, writer.depth_size),
                               .time = 7'000'000 + step * static_cast<std::uint64_t>(i),
                               .world_from_camera = some_pose(i)});
  }
  fs::path file() { return writer.save(folder.path() / "scene0000_00.sens"); }
  std::string refused() {
    const fs::path saved = file();
    return refusal([&] { Imported{saved}; });
  }

  TemporaryFolder folder;
  SensWriter writer;
};

TEST_F(ScanNetTest, GivesWhatWasWritten) {
  add(3);
  const Imported imported(file());
  ASSERT_EQ(imported.read.pairs.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(imported.read.pairs[i].color.time, 7 + 0.033333 * i, 1e-6);
    EXPECT_NEAR(imported.read.pairs[i].depth.time, 7.001 + 0.033333 * i, 1e-6);
    EXPECT_NEAR(imported.metres(i, 20, 30), 1.5 + 0.001 * i, 1e-9);
    EXPECT_LT(cv::norm(imported.color(i), flat_color({64, 48}), cv::NORM_INF), 5);
    expect_pose(imported.truth()[i].world_from_camera, some_pose(static_cast<int>(i)));
  }
  EXPECT_EQ(imported.camera.fx, 60);
  EXPECT_EQ(imported.camera.cx, 31.5);
  EXPECT_THAT(imported.notes, IsEmpty());
}

TEST_F(ScanNetTest, IsFoundInItsFolder) {
  add(1);
  file();
  folder.write("scene0000_00.txt", "axisAlignment = 1 0 0 0\n");
  EXPECT_EQ(Imported(folder.path()).read.pairs.size(), 1u);
}

TEST_F(ScanNetTest, ColourIsScaledToDepthWithItsCamera) {
  writer.color_size = {130, 98};
  writer.color_focal = 122;
  add(1);
  const Imported imported(file());
  EXPECT_EQ(imported.color(0).size(), cv::Size(64, 48));
  EXPECT_NEAR(imported.camera.fx, 122 * 64.0 / 130, 1e-9);
  EXPECT_NEAR(imported.camera.cx, 31.5, 1e-9);  // the centre stays the centre
  EXPECT_THAT(imported.notes, ElementsAre(HasSubstr("scaled from 130 x 98 to 64 x 48")));
}

TEST_F(ScanNetTest, DepthMovesIntoTheColourCamera) {
  writer.color_from_depth.translation().x() = 0.1;  // 6 px at 1 m, 3 px at 2 m
  add(1);
  cv::Mat& depth = writer.images[0].depth;
  depth.setTo(2000);
  depth(cv::Rect(20, 10, 8, 8)).setTo(1000);
  const Imported imported(file());
  const cv::Mat moved = imported.depth(0);
  cv::Mat expected = flat_depth(2000, {64, 48});
  expected(cv::Rect(0, 0, 3, 48)).setTo(0);      // not seen by the depth camera
  expected(cv::Rect(23, 10, 11, 8)).setTo(0);    // behind the nearer surface
  expected(cv::Rect(26, 10, 8, 8)).setTo(1000);  // the nearer surface
  EXPECT_EQ(cv::norm(moved, expected, cv::NORM_INF), 0) << moved.row(12);
  expect_pose(imported.truth()[0].world_from_camera,
              some_pose(0) * writer.color_from_depth.inverse());
}

TEST_F(ScanNetTest, OtherKindsOfImages) {
  writer.color_kind = 1;
  writer.depth_kind = 0;
  add(2);
  const Imported imported(file());
  EXPECT_EQ(cv::norm(imported.color(1), flat_color({64, 48}), cv::NORM_INF), 0);
  EXPECT_NEAR(imported.metres(1, 5, 5), 1.501, 1e-9);
}

TEST_F(ScanNetTest, ALostCameraHasNoTruth) {
  add(3);
  writer.images[1].world_from_camera.reset();
  const Imported imported(file());
  EXPECT_EQ(imported.read.pairs.size(), 3u);
  EXPECT_EQ(imported.truth().size(), 2u);
  EXPECT_THAT(imported.notes, ElementsAre("1 of 3 images have no true pose"));
}

TEST_F(ScanNetTest, StampsThatDoNotRiseBecomeThoseOf30Hz) {
  add(3, 0);
  const Imported imported(file());
  EXPECT_NEAR(imported.read.pairs[2].color.time, 2 / 30.0, 1e-6);
  EXPECT_NEAR(imported.read.pairs[2].depth.time, 2 / 30.0, 1e-6);
  EXPECT_THAT(imported.notes, ElementsAre(HasSubstr("30 Hz")));
}

TEST_F(ScanNetTest, TruncatedAnywhereIsRefused) {
  add(3);
  const auto whole = writer.bytes();
  const std::size_t end_of_frames = whole.size() - 8;
  for (std::size_t size = 0; size < end_of_frames; size += 61) {
    folder.write("cut.sens", std::string(whole.begin(), whole.begin() + static_cast<long>(size)));
    EXPECT_THROW(SensFile(folder.path() / "cut.sens", 99), Error) << size;
  }
  fs::resize_file(file(), end_of_frames - 10);
  const fs::path cut = folder.path() / "scene0000_00.sens";
  EXPECT_THAT(
      refusal([&] { Imported{cut}; }),
      HasSubstr("scene0000_00.sens: ends within frame 3 of 3; load it anew, or take what is "
                "whole: --frames 2"));
  EXPECT_EQ(Imported(cut, {.most_frames = 2}).read.pairs.size(), 2u);
}

TEST_F(ScanNetTest, DamagedFilesAreRefused) {
  EXPECT_THAT(refused(), HasSubstr("has no frames"));
  add(2);
  writer.version = 3;
  EXPECT_THAT(refused(), HasSubstr("is no .sens file of version 4 (its version is 3)"));
  writer.version = 4;
  writer.depth_kind = 2;
  EXPECT_THAT(refused(), HasSubstr("has depth images of an unknown kind"));
  writer.depth_kind = 1;
  writer.depth_unit = 0;
  EXPECT_THAT(refused(), HasSubstr("the unit of depth is 0"));
  writer.depth_unit = 1000;
  writer.color_focal = 0;
  EXPECT_THAT(refused(), HasSubstr("has no calibration of the colour camera"));
}

TEST_F(ScanNetTest, ImagesOfAnotherSizeAreRefused) {
  add(2);
  writer.images[1].depth = flat_depth(1, {32, 24});
  EXPECT_THAT(refused(), HasSubstr("the depth image of frame 2 cannot be decompressed"));
  writer.images[1].depth = flat_depth(1, {64, 48});
  writer.images[1].color = flat_color({32, 24});
  EXPECT_THAT(refused(), HasSubstr("colour image of frame 2: is damaged or of another size"));
}

TEST_F(ScanNetTest, HugeSizesAllocateNothing) {
  writer.depth_size = {16384, 16384};
  writer.images.push_back({.color = flat_color({64, 48}), .depth = flat_depth(1, {64, 48})});
  EXPECT_THAT(refused(), HasSubstr("the depth image of frame 1 is too short"));
}

}  // namespace
}  // namespace stillpoint::importing
