#include "stillpoint/runtime/moving_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "doubles.hpp"

namespace stillpoint {
namespace {

using testing::CallLog;
using Strings = std::vector<std::string>;

MovingPoints check(MovingCheck& stage, std::uint32_t index) {
  return stage.check(std::make_shared<const Frame>(testing::make_frame(index)), SparseMap());
}

TEST(MovingCheck, ComparesEachFrameWithTheOneBefore) {
  CallLog calls;
  TimeLog times;
  MovingCheck stage({std::make_shared<testing::FakeChecker>(calls), "lk"}, RuntimeOptions(), times);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(check(stage, i).reliable, i > 0);
  EXPECT_EQ(calls.entries("check"), (Strings{"check 0 1", "check 1 2"}));
  EXPECT_EQ(times.take().size(), 2u);
}

Pose at_x(double metres) { return Pose(Eigen::Translation3d(metres, 0, 0)); }

/// Key frame `id` was made of frame 10 · id, and stood there at x = id.
DenseKeyFrame make_keyframe(KeyFrameId id) {
  return {.id = id,
          .frame = std::make_shared<const Frame>(testing::make_frame(10 * id)),
          .segmentation = nullptr,
          .weights = std::make_shared<const StaticWeights>(),
          .world_from_camera = at_x(id)};
}

TEST(MovingCheck, DoesNotKeepAllKeyFramesOfALongRun) {
  CallLog calls;
  TimeLog times;
  const auto checker = std::make_shared<testing::FakeChecker>(calls);
  checker->wanted = 401;
  try {
    MovingCheck({checker, "lk"}, RuntimeOptions(), times);
    FAIL() << "401 key frames are a gigabyte of images";
  } catch (const StageError& error) {
    EXPECT_THAT(error.what(), ::testing::HasSubstr("wanted_keyframes() gives 401, above 400"));
  }
}

TEST(MovingCheck, ShowsWhatWasTrackedAtThePosesOfTheMap) {
  CallLog calls;
  TimeLog times;
  const auto checker = std::make_shared<testing::FakeChecker>(calls);
  checker->wanted = 2;
  MovingCheck stage({checker, "lk"}, RuntimeOptions(), times);
  check(stage, 0);
  for (KeyFrameId id = 0; id < 4; ++id) stage.keyframe(make_keyframe(id));
  TrackedFrame previous{.frame = std::make_shared<const Frame>(testing::make_frame(0))};
  previous.reference = 2;
  previous.reference_from_camera = at_x(0.5);
  stage.tracked(previous);
  // The map has moved key frames by 100 m since, and does not have the last one yet.
  MapEdit map{SparseMap()};
  for (KeyFrameId id = 0; id < 3; ++id) {
    KeyFrame keyframe{.id = id, .world_from_camera = at_x(100.0 + id)};
    keyframe.features = std::make_shared<const Features>();
    map.add_keyframe(std::move(keyframe));
  }
  const auto frame = std::make_shared<const Frame>(testing::make_frame(1));
  stage.check(frame, map.map());
  const TrackingHistory& history = checker->history;
  ASSERT_TRUE(history.world_from_previous);
  EXPECT_EQ(history.world_from_previous->translation().x(), 102.5);
  ASSERT_EQ(history.keyframes.size(), 2u) << "as many as it wants";
  EXPECT_EQ(history.keyframes[0].id, 3u) << "newest first";
  EXPECT_EQ(history.keyframes[0].world_from_camera.translation().x(), 3.0);
  EXPECT_EQ(history.keyframes[1].world_from_camera.translation().x(), 102.0);
  EXPECT_EQ(history.keyframes[1].frame->index, 20u);
  EXPECT_TRUE(history.keyframes[1].weights);
  stage.tracked(std::nullopt);
  stage.check(std::make_shared<const Frame>(testing::make_frame(2)), map.map());
  EXPECT_FALSE(checker->history.world_from_previous) << "lost";
}

TEST(MovingCheck, AFailureIsNamed) {
  CallLog calls;
  TimeLog times;
  calls.failing = "check 0 1";
  MovingCheck stage({std::make_shared<testing::FakeChecker>(calls), "lk"}, RuntimeOptions(), times);
  check(stage, 0);
  try {
    check(stage, 1);
    FAIL() << "no exception";
  } catch (const StageError& error) {
    EXPECT_STREQ(error.what(), "moving check (lk) failed on frame 1: out of ideas");
  }
}

TEST(MovingCheck, WithoutACheckerNothingIsKnown) {
  TimeLog times;
  MovingCheck stage({}, RuntimeOptions(), times);
  EXPECT_FALSE(stage.present());
  for (std::uint32_t i = 0; i < 2; ++i) EXPECT_TRUE(check(stage, i).points.empty());
  EXPECT_TRUE(times.take().empty());
}

}  // namespace
}  // namespace stillpoint
