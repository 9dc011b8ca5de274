#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "dense_map/map_difference.hpp"
#include "dense_map/map_picture.hpp"
#include "dense_map/map_summary.hpp"
#include "semantic_octree/test_map.hpp"
#include "stillpoint/error.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::dense_map {
namespace {

using semantic_octree::read_octree;
using semantic_octree::TestMap;
using semantic_octree::TestMapOptions;
using semantic_octree::TestRoom;

namespace fs = std::filesystem;

// Maps of the test room, with and without its pillar, a chair by its class.
class SavedMaps : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<testing::TemporaryFolder>();
    TestRoom room;
    save(room, "with", {});
    save(room, "coarse", {.resolution = 0.1});
    save(room, "hits", {.carve = false});
    room.pillar = false;
    save(room, "without", {});
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static void save(const TestRoom& room, const std::string& name, const TestMapOptions& options) {
    fs::create_directories(folder() / name);
    TestMap(room, options).save(folder() / name);
  }
  static SavedOctree saved(const std::string& name) {
    return read_octree(folder() / name / "map.ot");
  }

  static fs::path folder() { return folder_->path(); }

  static inline std::unique_ptr<testing::TemporaryFolder> folder_;
};

TEST_F(SavedMaps, SummaryOfARoom) {
  const MapSummary summary = summarise(saved("with"));
  EXPECT_EQ(summary.resolution, 0.05);
  // Walls at ±1.93 and ±2.41 m, the floor at 0.02 m.
  EXPECT_NEAR(summary.low.x(), -1.95, 0.051);
  EXPECT_NEAR(summary.high.x(), 1.95, 0.051);
  EXPECT_NEAR(summary.high.y() - summary.low.y(), 4.85, 0.11);
  EXPECT_NEAR(summary.low.z(), 0.0, 0.051);
  // The room has 18.6 m² of floor and 44 m² of walls, of which the ceiling's side is not seen.
  EXPECT_GT(summary.surface(), 40);
  EXPECT_LT(summary.surface(), 70);
  EXPECT_GT(summary.free, 10 * summary.occupied);
  ASSERT_EQ(summary.classes.size(), 2U);
  EXPECT_EQ(summary.classes[0].name, "background");
  EXPECT_EQ(summary.classes[1].name, "chair");
  EXPECT_EQ(summary.classes[0].voxels + summary.classes[1].voxels, summary.occupied);
  EXPECT_GT(summary.classes[1].confidence, 0.9);
  const std::string table = summary_table(summary, "room.ot");
  EXPECT_THAT(table, ::testing::HasSubstr("5 cm, colours and classes"));
  EXPECT_THAT(table, ::testing::ContainsRegex("chair +[0-9,]+ +[0-9.]+ %"));
  EXPECT_EQ(summary_json(summary)["occupied_voxels"], summary.occupied);
}

TEST_F(SavedMaps, AMapIsAsItself) {
  const MapDifference same = compare(saved("with"), saved("with"));
  EXPECT_EQ(same.overlap(), 1.0);
  EXPECT_EQ(same.other_class, 0U);
  EXPECT_TRUE(same.classes);
  EXPECT_TRUE(same.points.empty());
}

TEST_F(SavedMaps, WhatHasGone) {
  const MapDifference difference = compare(saved("with"), saved("without"));
  // Half of the pillar was seen: half of 2 π 0.3 m by about 2 m.
  const double pillar = M_PI * 0.3 * 2.0 / (0.05 * 0.05);
  EXPECT_NEAR(static_cast<double>(difference.only_first), pillar, 0.4 * pillar);
  EXPECT_GT(difference.gone, difference.only_first / 2);
  int on_pillar = 0;
  for (const LabelledPoint& point : difference.points)
    if (point.label == 1)
      on_pillar +=
          std::abs(std::hypot(point.position.x() - 0.52, point.position.y() - 1.03) - 0.3) < 0.1;
  EXPECT_GT(on_pillar, 0.8 * static_cast<double>(difference.only_first));
  // What stood behind it was not seen with it.
  EXPECT_GT(difference.only_second, difference.appeared);
  EXPECT_EQ(difference.points.size(), difference.only_first + difference.only_second);
  const MapDifference back = compare(saved("without"), saved("with"));
  EXPECT_EQ(back.only_second, difference.only_first);
  EXPECT_EQ(back.appeared, difference.gone);
  EXPECT_THAT(difference_table(difference, "a", "b"), ::testing::HasSubstr("of another class"));
}

TEST_F(SavedMaps, DifferentResolutionsAreRefused) {
  try {
    compare(saved("with"), saved("coarse"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "voxels of 5 and of 10 cm cannot be compared; make both maps with the same "
                 "resolution");
  }
}

double share_of(const cv::Mat& picture, bool (*is)(const cv::Vec3b&)) {
  int count = 0;
  for (int y = 0; y < picture.rows; ++y)
    for (int x = 0; x < picture.cols; ++x) count += is(picture.at<cv::Vec3b>(y, x));
  return static_cast<double>(count) / static_cast<double>(picture.total());
}

bool is_paper(const cv::Vec3b& p) { return p[0] == 255 && p[1] == 255 && p[2] == 255; }
// The pillar's colour, (30, 40, 210), in any light.
bool is_red(const cv::Vec3b& p) { return p[2] > 4 * p[1] && p[2] > 4 * p[0] && p[2] > 80; }

TEST_F(SavedMaps, APictureShowsAllOfTheMap) {
  for (const double elevation : {90.0, 50.0, 10.0}) {
    const cv::Mat picture =
        picture_of(saved("with"), {.size = {320, 240}, .azimuth = 0, .elevation = elevation});
    ASSERT_EQ(picture.size(), cv::Size(320, 240));
    EXPECT_GT(share_of(picture, is_paper), 0.05) << elevation;
    EXPECT_LT(share_of(picture, is_paper), 0.9) << elevation;
    // A border of paper is all around: nothing is cut off.
    for (const cv::Rect& side : {cv::Rect(0, 0, 320, 1), cv::Rect(0, 239, 320, 1),
                                 cv::Rect(0, 0, 1, 240), cv::Rect(319, 0, 1, 240)})
      EXPECT_EQ(share_of(picture(side), is_paper), 1.0) << elevation;
  }
}

TEST_F(SavedMaps, WallsDoNotHideTheRoom) {
  // From outside, beyond the wall at x = 1.93 m, at eye level.
  PictureOptions options{.size = {320, 240}};
  options.eye = Eigen::Vector3d(5, 0.8, 1.2);
  options.target = Eigen::Vector3d(0.5, 0.8, 1.2);
  EXPECT_GT(share_of(picture_of(saved("with"), options), is_red), 0.02);
  EXPECT_EQ(share_of(picture_of(saved("without"), options), is_red), 0.0);
  // Without free space nothing says which side of a wall is the inner one.
  EXPECT_LT(share_of(picture_of(saved("hits"), options), is_red), 0.005);
}

TEST_F(SavedMaps, ClassesHaveTheirColours) {
  PictureOptions options{.mode = PictureOptions::Mode::kClass, .size = {320, 240}};
  options.eye = Eigen::Vector3d(0.5, -1.2, 1.2);
  options.target = Eigen::Vector3d(0.5, 1, 1.2);
  // A chair is (192, 0, 0) in PASCAL VOC's palette.
  EXPECT_GT(share_of(picture_of(saved("with"), options), is_red), 0.05);
}

TEST_F(SavedMaps, WhatCannotBeDrawnIsSaid) {
  const SavedOctree occupancy = read_octree(folder() / "with" / "map.bt");
  EXPECT_THROW(picture_of(occupancy, {}), Error);
  EXPECT_THROW(picture_of(occupancy, {.mode = PictureOptions::Mode::kClass}), Error);
  PictureOptions options;
  options.eye = options.target = Eigen::Vector3d(1, 1, 1);
  EXPECT_THROW(picture_of(saved("with"), options), Error);
  EXPECT_THROW(picture_of(saved("with"), {.highest = -50}), Error);
  EXPECT_THROW(write_picture(cv::Mat(10, 10, CV_8UC3), "/proc/no_such_folder/map.png"), Error);
}

}  // namespace
}  // namespace stillpoint::dense_map
