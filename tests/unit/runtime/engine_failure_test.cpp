// A stage that fails, or gives what cannot be: the run ends with its name, and what was computed is
// saved.
#include <gtest/gtest.h>

#include <cmath>

#include "engine_fixture.hpp"

namespace stillpoint {
namespace {

using testing::EngineFixture;
using testing::runtime;

struct FailureCase {
  const char* name;
  const char* entry;
  const char* message;
};

class EngineFailure : public ::testing::TestWithParam<std::tuple<Mode, FailureCase>> {};
INSTANTIATE_TEST_SUITE_P(
    Stages, EngineFailure,
    ::testing::Combine(
        ::testing::Values(Mode::kInline, Mode::kThreaded),
        ::testing::Values(
            FailureCase{"Source", "source 4", "source (list) failed on frame 4: out of ideas"},
            FailureCase{"Segmenter", "segment 4",
                        "segmentation (net) failed on frame 4: out of ideas"},
            FailureCase{"Propagator", "propagate 4 4",
                        "propagation (flow) failed on frame 4: out of ideas"},
            FailureCase{"Checker", "check 3 4",
                        "moving check (lk) failed on frame 4: out of ideas"},
            FailureCase{"Decision", "decide 4", "decision (vote) failed on frame 4: out of ideas"},
            FailureCase{"Prepare", "prepare 4", "tracking (orb) failed on frame 4: out of ideas"},
            FailureCase{"Track", "track 4", "tracking (orb) failed on frame 4: out of ideas"},
            FailureCase{"FirstInsert", "insert 0",
                        "local mapping (orb) failed on frame 0: out of ideas"},
            FailureCase{"Insert", "insert 4",
                        "local mapping (orb) failed on frame 4: out of ideas"},
            FailureCase{"Refine", "refine 4",
                        "local mapping (orb) failed on frame 4: out of ideas"},
            FailureCase{"Closer", "close 0", "loop closing (bits) failed on frame 0: out of ideas"},
            FailureCase{"Adjustment", "adjust 0",
                        "loop closing (bits) failed on frame 0: out of ideas"},
            FailureCase{"Backend", "integrate 4",
                        "dense mapping (cloud) failed on frame 4: out of ideas"},
            FailureCase{"Save", "save 0", "dense mapping (cloud) failed: out of ideas"},
            FailureCase{"Output", "output 4", "output (first) failed on frame 4: out of ideas"},
            FailureCase{"Finish", "finish 0", "output (first) failed: out of ideas"})),
    [](const auto& test) {
      return std::string(std::get<0>(test.param) == Mode::kInline ? "Inline" : "Threaded") +
             std::get<1>(test.param).name;
    });

TEST_P(EngineFailure, IsNamedAndWhatWasComputedIsSaved) {
  const auto& [mode, failure] = GetParam();
  EngineFixture f(200);
  f.calls.failing = failure.entry;
  Engine engine(f.stages(), runtime(mode), {});
  try {
    engine.run();
    FAIL() << "no exception";
  } catch (const StageError& error) {
    EXPECT_STREQ(error.what(), failure.message);
    EXPECT_EQ(error.fault(), Fault::kStage);
  }
  EXPECT_EQ(f.output->finished, 1);
  EXPECT_EQ(f.second_output->finished, 1);
  EXPECT_FALSE(f.second_output->complete);
  EXPECT_EQ(f.second_output->failure, failure.message);
}

class FaultOfAStage : public ::testing::TestWithParam<Mode> {
 protected:
  /// Of a run with this source: what it threw.
  std::string message_of(std::shared_ptr<Source> source, Fault fault) {
    EngineFixture f;
    f.source = std::move(source);
    std::string message = "no exception";
    try {
      Engine(f.stages(), runtime(GetParam()), {}).run();
    } catch (const Error& error) {
      EXPECT_EQ(error.fault(), fault);
      message = error.what();
    }
    EXPECT_EQ(f.output->finished, 1);
    EXPECT_EQ(f.output->before_first_frame, f.output->poses.empty());
    return message;
  }
};
INSTANTIATE_TEST_SUITE_P(Modes, FaultOfAStage, ::testing::Values(Mode::kInline, Mode::kThreaded),
                         [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

class UnusableSource final : public Source {
 public:
  std::optional<Frame> next() override {
    throw Error(Fault::kData, "not a number", "rgb.txt:3", "remove the line");
  }
};

TEST_P(FaultOfAStage, OfUnusableDataStaysADataFault) {
  EXPECT_EQ(message_of(std::make_shared<UnusableSource>(), Fault::kData),
            "source (list) failed on frame 0: rgb.txt:3: not a number; remove the line");
}

class SourceWithoutDepth final : public Source {
 public:
  std::optional<Frame> next() override {
    Frame frame = testing::make_frame(0);
    frame.depth.release();
    return frame;
  }
};

TEST_P(FaultOfAStage, FramesWithoutDepthAreTheSourcesFault) {
  EXPECT_EQ(
      message_of(std::make_shared<SourceWithoutDepth>(), Fault::kStage),
      "source (list) failed on frame 0: the colour, grey and depth images of a frame differ in "
      "size; all three are needed, of the camera's size");
}

/// Right for three frames, then without a pose.
class TrackerThatDiverges final : public Tracker {
 public:
  explicit TrackerThatDiverges(testing::CallLog& calls) : tracker_(calls) {}
  PreparedFramePtr prepare(FramePtr frame) override { return tracker_.prepare(std::move(frame)); }
  TrackResult track(PreparedFramePtr prepared, const StaticWeights& weights, const SparseMap& map,
                    TrackHints hints) override {
    const std::uint32_t frame = prepared->frame->index;
    TrackResult result = tracker_.track(std::move(prepared), weights, map, hints);
    if (frame == 3) result.world_from_camera.translation().x() = std::nan("");
    return result;
  }

 private:
  testing::FakeTracker tracker_;
};

/// Judges pixels of another image.
class DecisionOnAnotherImage final : public Decision {
 public:
  StaticWeights decide(const Frame&, const Segmentation&, const MovingPoints&,
                       const MapEvidence&) override {
    return {.track = cv::Mat::zeros(2, 2, CV_8UC1)};
  }
};

TEST_P(FaultOfAStage, WrongResultsEndTheRunWithTheStageThatGaveThem) {
  const auto message = [](EngineFixture& f, Stages stages) -> std::string {
    try {
      Engine(std::move(stages), runtime(GetParam()), {}).run();
    } catch (const StageError& error) {
      EXPECT_EQ(f.output->finished, 1);
      EXPECT_EQ(f.output->failure, error.what());
      return error.what();
    }
    return "no exception";
  };
  EngineFixture diverging;
  Stages stages = diverging.stages();
  stages.tracker = {std::make_shared<TrackerThatDiverges>(diverging.calls), "mine"};
  EXPECT_EQ(
      message(diverging, std::move(stages)),
      "tracking (mine) failed on frame 3: the pose is no rigid motion; it must be finite, with "
      "an orthonormal rotation; return kLost where there is none");
  EXPECT_EQ(diverging.output->poses.size(), 3u);
  EngineFixture misjudging;
  stages = misjudging.stages();
  stages.decision = {std::make_shared<DecisionOnAnotherImage>(), "mine"};
  EXPECT_EQ(message(misjudging, std::move(stages)),
            "decision (mine) failed on frame 0: the weights have 2 x 2 pixels, but the frame has "
            "1 x 1; give one byte per pixel of the frame, or an empty image");
}

}  // namespace
}  // namespace stillpoint
