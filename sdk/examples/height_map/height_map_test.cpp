#include "height_map.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stillpoint/testing/test_recording.hpp>

namespace {

namespace fs = std::filesystem;
using stillpoint::testing::TestRecording;

/// A room with furniture, and a person who walks through it. The floor is 1.5 m below the camera.
const TestRecording& recording() {
  static const TestRecording recording({.frames = 4});
  return recording;
}

HeightMap map() {
  return {HeightMap::Options{.grid = {.resolution = 0.07}, .step = 1},
          stillpoint::testing::test_context()};
}

/// Metres above the floor; nothing: not known.
std::optional<float> height_at(const HeightGrid& grid, const Eigen::Vector3f& point_in_world) {
  const cv::Point cell = grid.cell_of(grid.map_from_world * point_in_world);
  const bool inside = cv::Rect({}, grid.heights.size()).contains(cell);
  if (!inside || grid.known.at<std::uint8_t>(cell) == 0) return std::nullopt;
  return grid.heights.at<float>(cell);
}

void expect_height(const HeightGrid& grid, const Eigen::Vector3f& point_in_world, float height) {
  ASSERT_TRUE(height_at(grid, point_in_world)) << point_in_world.transpose();
  EXPECT_NEAR(*height_at(grid, point_in_world), height, 0.05) << point_in_world.transpose();
}

TEST(HeightMap, HasFloorFurnitureAndWalls) {
  HeightMap mine = map();
  mine.integrate(recording().dense_keyframe(0, 0));
  const auto grid = mine.grid();
  ASSERT_TRUE(grid);
  EXPECT_NEAR(grid->map_from_world.translation().z(), 1.5, 0.01);  // of the camera
  expect_height(*grid, {-0.7F, 0, 3.7F}, 0.0F);                    // floor
  expect_height(*grid, {0.1F, 0, 2.7F}, 0.8F);                     // a box
  expect_height(*grid, {-1.6F, 0, 2.6F}, 1.3F);                    // the front of a higher one
  expect_height(*grid, {-0.7F, 0, 4.0F}, 1.8F);                    // wall, up to `max_height`
  EXPECT_FALSE(height_at(*grid, {0.1F, 0, 3.2F}));                 // behind a box
}

TEST(HeightMap, WhatMovesIsLeftOut) {
  const Eigen::Vector3f person(-0.8F, 0, 1.7F);  // the side that the camera sees
  HeightMap without = map(), with = map();
  stillpoint::DenseKeyFrame keyframe = recording().dense_keyframe(0, 0);
  without.integrate(keyframe);
  keyframe.weights = nullptr;
  with.integrate(keyframe);
  EXPECT_FALSE(height_at(*without.grid(), person));
  EXPECT_TRUE(height_at(*with.grid(), person));
}

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0;
}

TEST(HeightMap, FollowsItsKeyFrames) {
  HeightMap right = map(), corrected = map();
  for (stillpoint::KeyFrameId id = 0; id < 2; ++id) {
    stillpoint::DenseKeyFrame keyframe = recording().dense_keyframe(3 * id, id);
    right.integrate(keyframe);
    keyframe.world_from_camera.translation().y() -= 0.3 * id;  // the second one has drifted
    corrected.integrate(keyframe);
  }
  const cv::Mat heights = right.grid()->heights;
  EXPECT_FALSE(same(corrected.grid()->heights, heights));
  corrected.move(std::vector<stillpoint::MovedKeyFrame>{{1, recording().world_from_camera(3)}});
  EXPECT_TRUE(same(corrected.grid()->heights, heights));
}

TEST(HeightMap, SavesMetresAsSixteenBits) {
  const fs::path folder = fs::path(::testing::TempDir()) / "height_map_test";
  fs::create_directories(folder);
  HeightMap mine = map();
  mine.save(folder);  // no floor yet: a warning
  EXPECT_TRUE(fs::is_empty(folder));
  mine.integrate(recording().dense_keyframe(0, 0));
  mine.save(folder);
  const HeightGrid grid = *mine.grid();
  const cv::Mat image = cv::imread((folder / "height_map.png").string(), cv::IMREAD_UNCHANGED);
  ASSERT_EQ(image.type(), CV_16UC1);
  ASSERT_EQ(image.size(), grid.heights.size());
  EXPECT_TRUE(same(image != 0, grid.known));
  cv::Mat metres;
  image.convertTo(metres, CV_32F, (1.8 + 0.5) / 65535, -0.5);
  EXPECT_LT(cv::norm(metres, grid.heights, cv::NORM_INF, grid.known), 1e-4);
  fs::remove_all(folder);
}

}  // namespace
