// A tracker that gives the map up and begins a new one.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <stop_token>
#include <string>
#include <thread>
#include <vector>

#include "engine_fixture.hpp"

namespace stillpoint {
namespace {

using testing::EngineFixture;
using testing::runtime;

constexpr std::uint32_t kLost = 4, kAnew = 6, kFrames = 12;  // frames

/// Every second frame is a key frame. From `kLost` on it is lost, with `kAnew` it begins anew.
class TrackerThatBeginsAnew final : public Tracker {
 public:
  explicit TrackerThatBeginsAnew(testing::CallLog& calls) : tracker_(calls) {}
  PreparedFramePtr prepare(FramePtr frame) override { return tracker_.prepare(std::move(frame)); }
  TrackResult track(PreparedFramePtr prepared, const StaticWeights& weights, const SparseMap& map,
                    TrackHints hints) override {
    const std::uint32_t frame = prepared->frame->index;
    may_begin_anew.push_back(hints.may_begin_anew);
    if (frame >= kLost && frame < kAnew) return {.state = TrackState::kLost};
    if (frame > kAnew) sees_the_new_map &= map.keyframe_id_begin() == kLost / 2;
    TrackResult result = tracker_.track(std::move(prepared), weights, map, hints);
    if (frame != kAnew || !hints.may_begin_anew) return result;
    while_beginning();
    result.begins_anew = true;
    result.world_from_camera = result.keyframe->world_from_camera = Pose::Identity();
    return result;
  }

  std::function<void()> while_beginning = [] {};
  std::vector<bool> may_begin_anew;
  bool sees_the_new_map = true;  // in all frames after

 private:
  testing::FakeTracker tracker_;
};

class BegunAnew : public ::testing::TestWithParam<Mode> {
 protected:
  BegunAnew() {
    stages_.tracker = {tracker_, "anew"};
    stages_.log = [this](LogLevel, std::string_view text) { log_.emplace_back(text); };
  }

  EngineFixture f_{kFrames};
  Stages stages_ = f_.stages();
  std::shared_ptr<TrackerThatBeginsAnew> tracker_ =
      std::make_shared<TrackerThatBeginsAnew>(f_.calls);
  std::vector<std::string> log_;
};
INSTANTIATE_TEST_SUITE_P(Modes, BegunAnew, ::testing::Values(Mode::kInline, Mode::kThreaded),
                         [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

TEST_P(BegunAnew, BothMapsAreThoseSinceThen) {
  stages_.loop_closer = {};
  Engine engine(std::move(stages_), runtime(GetParam()), {});
  engine.run();
  EXPECT_EQ(engine.map()->keyframe_count(), 3u);
  EXPECT_EQ(engine.map()->keyframe_id_begin(), 2u);
  EXPECT_EQ(engine.map()->check(), std::nullopt);
  EXPECT_EQ(f_.backend->poses.size(), 3u);
  EXPECT_EQ(f_.calls.entries("clear").size(), 1u);
  EXPECT_TRUE(tracker_->sees_the_new_map);
  ASSERT_EQ(log_.size(), 1u);
  EXPECT_EQ(
      log_[0],
      "the tracker gives up its map and begins a new one with frame 6; frames tracked before, "
      "which have no pose any more: 4");
}

TEST_P(BegunAnew, FramesBeforeHaveNoPoseAndItWasLostOnce) {
  Engine engine(std::move(stages_), runtime(GetParam()), {});
  engine.run();
  ASSERT_EQ(engine.poses().size(), kFrames);
  for (std::uint32_t i = 0; i < kFrames; ++i)
    EXPECT_EQ(engine.poses()[i].state, i < kLost   ? TrackState::kWaiting
                                       : i < kAnew ? TrackState::kLost
                                                   : TrackState::kTracking)
        << i;
  EXPECT_EQ(engine.trajectory().size(), kFrames - kAnew);
  EXPECT_EQ(f_.output->statistics.tracked, kFrames - kAnew);
  EXPECT_EQ(f_.output->statistics.times_lost, 1u);
}

// What the loop closer finds in the map before comes too late.
TEST_P(BegunAnew, CorrectionsOfTheMapBeforeArePassedOver) {
  f_.mapper->while_refining = [&](KeyFrameId id, const std::stop_token&) {
    if (id == 1) std::this_thread::sleep_for(std::chrono::milliseconds(20));
  };
  Engine engine(std::move(stages_), runtime(GetParam()), {});
  engine.run();
  EXPECT_EQ(engine.map()->keyframe_id_begin(), 2u);
  EXPECT_EQ(engine.map()->keyframe_count(), 3u);
  EXPECT_EQ(f_.backend->poses.size(), 3u);
}

TEST_P(BegunAnew, AStopMeanwhileLeavesPosesAndMapTogether) {
  for (int i = 0; i < 20; ++i) {
    std::stop_source stop;
    tracker_->while_beginning = [&] { stop.request_stop(); };
    EngineFixture f(kFrames);
    Stages stages = f.stages();
    stages.tracker = {tracker_, "anew"};
    Engine engine(std::move(stages), runtime(GetParam()), {});
    engine.run(stop.get_token());
    EXPECT_EQ(engine.trajectory().size(), engine.map()->keyframe_id_begin() == 0 ? kLost : 1u);
  }
}

TEST_P(BegunAnew, WithAKnownMapItMayNot) {
  MapEdit edit{SparseMap{}};
  edit.add_keyframe({.id = 0,
                     .camera = std::make_shared<const Camera>(),
                     .features = std::make_shared<const Features>()});
  stages_.known_map = std::move(edit).finish();
  Engine engine(std::move(stages_), runtime(GetParam()), {});
  EXPECT_EQ(engine.map()->keyframe_count(), 1u);
  engine.process(*f_.source->next());
  EXPECT_FALSE(tracker_->may_begin_anew.front());
}

}  // namespace
}  // namespace stillpoint
