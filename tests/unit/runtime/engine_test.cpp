#include "stillpoint/engine/engine.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <thread>
#include <vector>

#include "engine_fixture.hpp"

namespace stillpoint {
namespace {

using testing::CallLog;
using testing::EngineFixture;
using testing::runtime;
using Strings = std::vector<std::string>;

class EngineInBothModes : public ::testing::TestWithParam<Mode> {};
INSTANTIATE_TEST_SUITE_P(Modes, EngineInBothModes,
                         ::testing::Values(Mode::kInline, Mode::kThreaded), [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

TEST(Engine, InlineCallsTheBoxesInTheOrderOfThePaper) {
  EngineFixture f(2);
  Engine(f.stages(), runtime(Mode::kInline), {}).run();
  EXPECT_EQ(f.calls.entries(), (Strings{"source 0",      "segment 0", "prepare 0", "propagate 0 0",
                                        "decide 0",      "track 0",   "insert 0",  "refine 0",
                                        "integrate 0",   "close 0",   "adjust 0",  "output 0",  //
                                        "source 1",      "segment 1", "prepare 1", "check 0 1",
                                        "propagate 1 1", "decide 1",  "track 1",   "output 1",  //
                                        "save 0",        "finish 0"}));
}

TEST_P(EngineInBothModes, EveryFrameGoesThroughEveryBox) {
  EngineFixture f(40);
  Engine(f.stages(), runtime(GetParam()), {}).run();
  for (const char* call :
       {"source", "segment", "prepare", "propagate", "decide", "track", "output"})
    EXPECT_EQ(f.calls.entries(call).size(), 40u) << call;
  EXPECT_EQ(f.calls.entries("check").size(), 39u);
  for (const char* call : {"insert", "refine", "integrate"})
    EXPECT_EQ(f.calls.entries(call).size(), 20u) << call;
  // Threaded, no loop is looked for until the map shows the last one.
  const std::size_t closed = f.calls.entries("close").size();
  EXPECT_TRUE(GetParam() == Mode::kInline ? closed == 20 : closed >= 1 && closed <= 20) << closed;
  EXPECT_EQ(f.output->finished, 1);
  EXPECT_TRUE(f.output->complete);
  EXPECT_EQ(f.output->failure, "");
  EXPECT_EQ(f.output->poses.size(), 40u);
  EXPECT_EQ(f.output->source.skipped, 2u);
  EXPECT_EQ(f.output->dense_points, 20u);
  EXPECT_EQ(f.output->map_directory, f.stages().map_directory);
}

TEST_P(EngineInBothModes, WithoutADenseMapOutputsSeeNone) {
  EngineFixture f(5);
  Stages stages = f.stages();
  stages.map_backend = {};
  Engine(std::move(stages), runtime(GetParam()), {}).run();
  EXPECT_EQ(f.output->finished, 1);
  EXPECT_EQ(f.output->dense_points, 0u);
  EXPECT_EQ(f.output->map_directory, "");
}

TEST_P(EngineInBothModes, TheMovingCheckKnowsThePoseBeforeAndRecentKeyFrames) {
  EngineFixture f(6);
  Stages stages = f.stages();
  stages.loop_closer = {};
  const auto checker = std::make_shared<testing::FakeChecker>(f.calls);
  checker->wanted = 2;
  stages.moving_checker.object = checker;
  Engine(std::move(stages), runtime(GetParam()), {}).run();
  const TrackingHistory& history = checker->history;  // when the last frame was checked
  ASSERT_TRUE(history.world_from_previous);
  EXPECT_EQ(history.world_from_previous->translation().x(), 4.0);
  ASSERT_EQ(history.keyframes.size(), 2u);
  for (const std::uint32_t age : {0, 1}) {
    const DenseKeyFrame& keyframe = history.keyframes[age];
    EXPECT_EQ(keyframe.id, 2 - age) << "newest first";
    EXPECT_EQ(keyframe.frame->index, 4 - 2 * age);
    EXPECT_EQ(keyframe.world_from_camera.translation().x(), 4.0 - 2 * age);
    EXPECT_TRUE(keyframe.segmentation);
    EXPECT_TRUE(keyframe.weights);
  }
}

TEST(Engine, ThreadedTheMovingCheckRunsBesideTheExtractionOfFeatures) {
  EngineFixture f(3);
  f.calls.hook = [&](const std::string& entry) {
    if (entry == "prepare 1") f.calls.wait_for("propagate 1 1");
    if (entry == "check 1 2") f.calls.wait_for("prepare 2");
  };
  Engine(f.stages(), runtime(Mode::kThreaded), {}).run();
  EXPECT_EQ(f.calls.entries("track"), (Strings{"track 0", "track 1", "track 2"}));
}

class SlowOutput : public ::testing::TestWithParam<WhenFull> {};
INSTANTIATE_TEST_SUITE_P(Engine, SlowOutput, ::testing::Values(WhenFull::kAuto, WhenFull::kDrop),
                         [](const auto& test) {
                           return test.param == WhenFull::kAuto ? "Viewer" : "MayDrop";
                         });

TEST_P(SlowOutput, DelaysNothing) {
  EngineFixture f(60);
  CallLog of_viewer;
  of_viewer.hook = [&](const std::string& entry) {
    if (entry == "output 0") f.calls.wait_for("output 59");
  };
  Stages stages = f.stages();
  const auto viewer = std::make_shared<testing::FakeOutput>(of_viewer);
  viewer->is_viewer = GetParam() == WhenFull::kAuto;
  stages.outputs.push_back({{viewer, "viewer"}, GetParam()});
  Engine(std::move(stages), runtime(Mode::kThreaded), {}).run();
  EXPECT_EQ(f.calls.entries("output").size(), 60u);
  EXPECT_GT(viewer->dropped_reports, 0);
  EXPECT_EQ(of_viewer.entries("output").size() + static_cast<std::size_t>(viewer->dropped_reports),
            60u);
}

TEST_P(EngineInBothModes, CorrectionsReachTheMapsAlsoAtTheEnd) {
  EngineFixture f(60);
  Engine(f.stages(), runtime(GetParam()), {}).run();
  // Every key frame closes a loop that lifts the map by one metre. Threaded, a correction may be
  // computed before the last one is applied, and then replaces it. Key frames come in at y = 0.
  const SparseMap& map = f.output->map;
  ASSERT_EQ(map.keyframe_count(), 30u);
  EXPECT_GE(map.world_from_keyframe(29).translation().y(), 1.0);
  if (GetParam() == Mode::kInline) {
    EXPECT_DOUBLE_EQ(map.world_from_keyframe(0).translation().y(), 30.0);
  }
  ASSERT_EQ(f.backend->poses.size(), 30u);
  for (const auto& [id, pose] : f.backend->poses)
    EXPECT_TRUE(pose.isApprox(map.world_from_keyframe(id))) << id;
}

/// Removes the key frame before the one that it refines around.
class RemovingMapper final : public LocalMapper {
 public:
  explicit RemovingMapper(CallLog& calls) : mapper_(calls) {}
  SparseMap insert(SparseMap map, KeyFrame keyframe) override {
    return mapper_.insert(std::move(map), std::move(keyframe));
  }
  SparseMap refine(SparseMap map, KeyFrameId id, std::stop_token end_early) override {
    MapEdit edit(mapper_.refine(std::move(map), id, std::move(end_early)));
    if (id >= 2) edit.remove_keyframe(id - 1);
    return edit.map();
  }

 private:
  testing::FakeMapper mapper_;
};

/// Looks for loops late, and finds none.
class LateCloser final : public LoopCloser {
 public:
  explicit LateCloser(CallLog& calls) : calls_(calls) {}
  std::optional<MapCorrection> close(const SparseMap& map, KeyFrameId latest,
                                     std::stop_token) override {
    calls_.wait_for("refine 10");
    EXPECT_TRUE(map.keyframe(latest)) << latest;
    EXPECT_EQ(map.keyframe_id_end(), latest + 1) << "the map as it was";
    calls_.write("close", latest);
    return std::nullopt;
  }

 private:
  CallLog& calls_;
};

TEST(Engine, ALoopIsLookedForInTheMapAsItWasWhenTheKeyFrameCame) {
  EngineFixture f(12);
  Stages stages = f.stages();
  stages.local_mapper = {std::make_shared<RemovingMapper>(f.calls), "orb"};
  stages.loop_closer = {std::make_shared<LateCloser>(f.calls), "bits"};
  Engine(std::move(stages), runtime(Mode::kThreaded), {}).run();
  EXPECT_EQ(f.calls.entries("close").size(), 6u);
}

TEST_P(EngineInBothModes, AllTimesAreReportedOnceAndNameTheirFrame) {
  EngineFixture f(4);
  Engine(f.stages(), runtime(GetParam()), {}).run();
  std::set<std::pair<std::string, std::uint32_t>> seen;
  for (const StageTime& time : f.output->times) {
    EXPECT_GE(time.wall_ms, 0.0);
    if (time.stage == "dense" || time.stage == "map_correct" || time.stage.starts_with("loop"))
      continue;
    EXPECT_TRUE(seen.emplace(time.stage, time.frame).second) << time.stage << ' ' << time.frame;
  }
  std::size_t expected = 8 * 4 + 3 + 2 * 2;              // per frame, check, per key frame
  if (GetParam() == Mode::kThreaded) expected += 2 * 4;  // two kinds of waiting
  EXPECT_EQ(seen.size(), expected);
}

TEST_P(EngineInBothModes, NullStagesRunThrough) {
  EngineFixture f(5);
  Stages stages;
  stages.source = {f.source, "list"};
  stages.outputs = {{{f.output, "first"}}};
  Engine(std::move(stages), runtime(GetParam()), {}).run();
  EXPECT_EQ(f.output->poses.size(), 5u);
  EXPECT_TRUE(f.output->map.empty());
}

TEST_P(EngineInBothModes, NullMapperKeepsTheKeyFrames) {
  EngineFixture f(5);
  Stages stages = f.stages();
  stages.local_mapper = {};
  Engine(std::move(stages), runtime(GetParam()), {}).run();
  EXPECT_EQ(f.output->map.keyframe_count(), 3u);
}

TEST_P(EngineInBothModes, EmptyRecordingFinishes) {
  EngineFixture f(0);
  Engine(f.stages(), runtime(GetParam()), {}).run();
  EXPECT_EQ(f.output->finished, 1);
  EXPECT_TRUE(f.output->complete);
}

TEST(Engine, NeedsASource) { EXPECT_THROW(Engine({}, {}, {}).run(), Error); }

TEST_P(EngineInBothModes, AStopFromAnotherThreadEndsTheRun) {
  EngineFixture f(1'000'000'000);
  std::stop_source stop;
  std::jthread stopper([&] {
    f.calls.wait_for("output 5");
    stop.request_stop();
  });
  Engine(f.stages(), runtime(GetParam()), {}).run(stop.get_token());
  EXPECT_EQ(f.output->finished, 1);
  EXPECT_FALSE(f.output->complete);
  EXPECT_EQ(f.output->failure, "");
  EXPECT_FALSE(f.output->before_first_frame);
  EXPECT_GE(f.output->poses.size(), 6u);
}

TEST_P(EngineInBothModes, AStopBeforeTheRunProcessesNothing) {
  EngineFixture f;
  std::stop_source stop;
  stop.request_stop();
  Engine(f.stages(), runtime(GetParam()), {}).run(stop.get_token());
  EXPECT_EQ(f.output->poses.size(), 0u);
  EXPECT_EQ(f.output->finished, 1);
  EXPECT_TRUE(f.output->before_first_frame);
}

// A camera that is interrupted with the run, or a damaged image that nobody will use.
TEST(Engine, WhatTheSourceThrowsAfterAStopIsNoFailure) {
  EngineFixture f(1000);
  std::stop_source stop;
  f.calls.failing = "source 4";
  f.calls.hook = [&](const std::string& entry) {
    if (entry == f.calls.failing) stop.request_stop();
  };
  Engine(f.stages(), runtime(Mode::kThreaded), {}).run(stop.get_token());
  EXPECT_EQ(f.output->failure, "");
  EXPECT_FALSE(f.output->complete);
}

TEST(Engine, ARefinementEndsEarlyWhenAnotherKeyFrameWaits) {
  EngineFixture f(5);
  f.mapper->while_refining = [&](KeyFrameId id, std::stop_token end_early) {
    if (id > 0) return;
    f.calls.wait_for("track 2");  // a key frame, pushed while this one is being refined
    std::mutex mutex;
    std::condition_variable_any changed;
    std::unique_lock lock(mutex);
    changed.wait(lock, end_early, [] { return false; });
    EXPECT_TRUE(end_early.stop_requested());
  };
  Engine(f.stages(), runtime(Mode::kThreaded), {}).run();
  EXPECT_EQ(f.output->map.keyframe_count(), 3u);
}

TEST(Engine, AStopEndsTheRefinementUnderWay) {
  EngineFixture f(1);
  std::stop_source stop;
  f.mapper->while_refining = [&](KeyFrameId, std::stop_token end_early) {
    stop.request_stop();
    EXPECT_TRUE(end_early.stop_requested());
  };
  Engine(f.stages(), runtime(Mode::kThreaded), {}).run(stop.get_token());
  EXPECT_EQ(f.output->map.keyframe_count(), 1u);
}

TEST(Engine, InlineNeverEndsEarly) {
  EngineFixture f(9);
  f.mapper->while_refining = [](KeyFrameId, std::stop_token end_early) {
    EXPECT_FALSE(end_early.stop_requested());
  };
  Engine(f.stages(), runtime(Mode::kInline), {}).run();
}

}  // namespace
}  // namespace stillpoint
