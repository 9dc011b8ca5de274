#include "stillpoint/runtime/motion_stage.hpp"

#include <gtest/gtest.h>

#include <latch>

#include "doubles.hpp"

namespace stillpoint {
namespace {

using testing::Journal;
using Strings = std::vector<std::string>;

struct MotionFixture {
  Journal journal;
  StopSignal stop;
  TimeLog times;
  SegmentationStage segmentation{
      Stage<Segmenter>{std::make_shared<testing::FakeSegmenter>(journal), "net"},
      Stage<Propagator>{std::make_shared<testing::FakePropagator>(journal), "flow"},
      {},
      Mode::kInline,
      stop,
      times};
  Stage<MovingChecker> checker{std::make_shared<testing::FakeChecker>(journal), "lk"};
  Stage<MapChecker> map_checker;
  MapStore::Snapshot map = std::make_shared<const SparseMap>();

  std::unique_ptr<MotionStage> make(Mode mode) {
    return std::make_unique<MotionStage>(checker, map_checker, segmentation, mode, stop, times);
  }
  /// The camera is one metre farther along x in every frame.
  void track(MotionStage& stage, const FramePtr& frame) {
    TrackResult result{.state = TrackState::kTracking};
    result.world_from_camera = Pose(Eigen::Translation3d(frame->index, 0.0, 0.0));
    stage.tracked(frame, std::make_shared<const StaticWeights>(), result, map);
  }
  FramePtr offer(MotionStage& stage, std::uint32_t index) {
    auto frame = std::make_shared<const Frame>(testing::make_frame(index));
    segmentation.offer(frame);
    stage.offer(frame, map);
    return frame;
  }
};

class MotionStageInBothModes : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Modes, MotionStageInBothModes,
                         ::testing::Values(Mode::kInline, Mode::kThreaded), [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

TEST_P(MotionStageInBothModes, GivesPointsAndLabelsOfTheFrame) {
  MotionFixture f;
  const auto stage = f.make(GetParam());
  for (std::uint32_t i = 0; i < 3; ++i) {
    const SceneMotion motion = stage->at(f.offer(*stage, i));
    EXPECT_EQ(motion.points.reliable, i > 0);
    ASSERT_TRUE(motion.labels);
    EXPECT_EQ(motion.labels->frame, i);
  }
  EXPECT_EQ(f.journal.entries("check"), (Strings{"check 0 1", "check 1 2"}));
}

TEST_P(MotionStageInBothModes, AFailureOfTheCheckIsNamed) {
  MotionFixture f;
  f.journal.failing = "check 0 1";
  const auto stage = f.make(GetParam());
  stage->at(f.offer(*stage, 0));
  try {
    EXPECT_FALSE(stage->at(f.offer(*stage, 1)).labels);
    ASSERT_TRUE(f.stop.failure());
    std::rethrow_exception(f.stop.failure());
  } catch (const StageError& error) {
    EXPECT_STREQ(error.what(), "moving check (lk) failed on frame 1: out of ideas");
  }
}

TEST(MotionStage, InlineWaitsForTheFeatures) {
  MotionFixture f;
  const auto stage = f.make(Mode::kInline);
  stage->at(f.offer(*stage, 0));
  const FramePtr frame = f.offer(*stage, 1);
  EXPECT_TRUE(f.journal.entries("check").empty());
  stage->at(frame);
  EXPECT_TRUE(f.journal.contains("check 0 1"));
}

TEST(MotionStage, ThreadedRunsBesideItsCaller) {
  MotionFixture f;
  const auto stage = f.make(Mode::kThreaded);
  stage->at(f.offer(*stage, 0));
  const FramePtr frame = f.offer(*stage, 1);
  f.journal.wait_for("propagate 1 1");
  EXPECT_TRUE(stage->at(frame).points.reliable);
}

TEST(MotionStage, AStopEndsTheWait) {
  MotionFixture f;
  std::latch release(1);
  f.journal.hook = [&](const std::string& entry) {
    if (entry == "check 0 1") release.wait();
  };
  const auto stage = f.make(Mode::kThreaded);
  stage->at(f.offer(*stage, 0));
  const FramePtr frame = f.offer(*stage, 1);
  f.journal.wait_for("check 0 1");
  f.stop.request();
  EXPECT_FALSE(stage->at(frame).labels);
  release.count_down();
}

TEST_P(MotionStageInBothModes, WithoutACheckThereAreLabelsOnly) {
  MotionFixture f;
  f.checker = {};
  const auto stage = f.make(GetParam());
  for (std::uint32_t i = 0; i < 2; ++i) {
    const SceneMotion motion = stage->at(f.offer(*stage, i));
    EXPECT_TRUE(motion.points.points.empty());
    EXPECT_TRUE(motion.labels && motion.labels->known());
  }
  for (const StageTime& time : f.times.take()) EXPECT_NE(time.stage, "motion_wait");
}

TEST_P(MotionStageInBothModes, TheMapIsComparedWhereTheCameraMayBe) {
  MotionFixture f;
  const auto checker = std::make_shared<testing::FakeMapChecker>(f.journal);
  f.map_checker = {checker, "depth"};
  const auto stage = f.make(GetParam());
  for (std::uint32_t i = 0; i < 3; ++i) {
    const FramePtr frame = f.offer(*stage, i);
    EXPECT_EQ(stage->at(frame).evidence.log_odds.empty(), i == 0) << "nothing was tracked before";
    f.track(*stage, frame);
  }
  EXPECT_EQ(f.journal.entries("compare"), (Strings{"compare 1", "compare 2"}));
  EXPECT_EQ(f.journal.entries("remember"), (Strings{"remember 0", "remember 1"}));
  // With the velocity of before, and without motion.
  ASSERT_EQ(checker->last_guesses.size(), 4u);
  const std::vector<double> expected = {0.0, 0.0, 2.0, 1.0};
  for (std::size_t i = 0; i < expected.size(); ++i)
    EXPECT_NEAR(checker->last_guesses[i], expected[i], 1e-6);
}

TEST_P(MotionStageInBothModes, ALostCameraIsComparedWithNothing) {
  MotionFixture f;
  f.map_checker = {std::make_shared<testing::FakeMapChecker>(f.journal), "depth"};
  const auto stage = f.make(GetParam());
  const FramePtr first = f.offer(*stage, 0);
  stage->at(first);
  f.track(*stage, first);
  const FramePtr second = f.offer(*stage, 1);
  stage->at(second);
  stage->tracked(second, std::make_shared<const StaticWeights>(), {.state = TrackState::kLost},
                 f.map);
  EXPECT_TRUE(stage->at(f.offer(*stage, 2)).evidence.log_odds.empty());
  EXPECT_EQ(f.journal.entries("remember"), (Strings{"remember 0"}));
}

TEST(MotionStage, WaitingIsMeasured) {
  MotionFixture f;
  const auto stage = f.make(Mode::kThreaded);
  stage->at(f.offer(*stage, 7));
  Strings stages;
  for (const StageTime& time : f.times.take()) {
    EXPECT_EQ(time.frame, 7u);
    stages.push_back(time.stage);
  }
  EXPECT_EQ(std::ranges::count(stages, "motion_wait"), 1);
}

}  // namespace
}  // namespace stillpoint
