#include "my_plugin.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <stillpoint/testing/test_recording.hpp>
#include <vector>

namespace plugins::my_plugin {
namespace {

using stillpoint::testing::TestRecording;

const TestRecording& recording() {
  static const TestRecording recording({.frames = 2});
  return recording;
}

MyPlugin map() { return {MyPlugin::Options{}, stillpoint::testing::test_context()}; }

TEST(MyPlugin, ThePersonIsNotMapped) {
  MyPlugin without = map(), with = map();
  without.integrate(recording().dense_keyframe(0, 0));
  stillpoint::DenseKeyFrame all = recording().dense_keyframe(0, 0);
  all.weights = nullptr;
  with.integrate(all);
  const auto people = [](const std::vector<stillpoint::LabelledPoint>& points) {
    return std::ranges::count_if(points, [](const auto& point) { return point.label == 1; });
  };
  EXPECT_GT(without.occupied().size(), 1000u);
  EXPECT_EQ(people(without.occupied()), 0);
  EXPECT_GT(people(with.occupied()), 50);
}

TEST(MyPlugin, FollowsItsKeyFrames) {
  MyPlugin mine = map();
  mine.integrate(recording().dense_keyframe(0, 7));
  const Eigen::Vector3f before = mine.occupied().at(0).position;
  stillpoint::Pose moved = recording().world_from_camera(0);
  moved.translation().x() += 1;
  mine.move(std::vector<stillpoint::MovedKeyFrame>{{7, moved}, {99, moved}});
  EXPECT_NEAR((mine.occupied().at(0).position - before).x(), 1, 1e-5);
}

TEST(MyPlugin, SavesTheCloudAlsoWhenItIsEmpty) {
  const std::filesystem::path folder =
      std::filesystem::path(::testing::TempDir()) / "my_plugin_test";
  std::filesystem::create_directories(folder);
  MyPlugin mine = map();
  mine.save(folder);
  const auto empty = std::filesystem::file_size(folder / "my_plugin.ply");
  mine.integrate(recording().dense_keyframe(0, 0));
  mine.save(folder);
  EXPECT_GT(std::filesystem::file_size(folder / "my_plugin.ply"), empty + 10000);
  std::filesystem::remove_all(folder);
}

TEST(MyPlugin, WithoutDepthThereAreNoPoints) {
  auto frame = std::make_shared<stillpoint::Frame>(*recording().frame(0));
  frame->depth = cv::Mat(frame->depth.size(), CV_32FC1, cv::Scalar(0));
  MyPlugin mine = map();
  mine.integrate({.id = 0, .frame = frame});
  EXPECT_TRUE(mine.occupied().empty());
}

}  // namespace
}  // namespace plugins::my_plugin
