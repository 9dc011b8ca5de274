// An engine that is given frames instead of a source.
#include <gtest/gtest.h>

#include "engine_fixture.hpp"
#include "stillpoint/support/trajectory.hpp"

namespace stillpoint {
namespace {

using testing::EngineFixture;
using testing::make_frame;
using testing::runtime;
using Strings = std::vector<std::string>;

class PushedFrames : public ::testing::TestWithParam<Mode> {
 protected:
  Engine engine() {
    Stages stages = f_.stages();
    stages.source = {};
    return Engine(std::move(stages), runtime(GetParam()), {});
  }
  EngineFixture f_;
};
INSTANTIATE_TEST_SUITE_P(Modes, PushedFrames, ::testing::Values(Mode::kInline, Mode::kThreaded),
                         [](const auto& test) {
                           return test.param == Mode::kInline ? "Inline" : "Threaded";
                         });

std::string message_of(const std::function<void()>& call, Fault fault) {
  try {
    call();
  } catch (const Error& error) {
    EXPECT_EQ(error.fault(), fault) << error.what();
    return error.what();
  }
  return "no error";
}

TEST(PushedFramesInline, GoThroughTheBoxesAsThoseOfASource) {
  EngineFixture from_source(4), pushed;
  Engine(from_source.stages(), runtime(Mode::kInline), {}).run();
  Stages stages = pushed.stages();
  stages.source = {};
  Engine engine(std::move(stages), runtime(Mode::kInline), {});
  for (std::uint32_t i = 0; i < 4; ++i) engine.process(make_frame(i));
  engine.finish();
  Strings expected;
  for (const std::string& entry : from_source.calls.entries())
    if (!entry.starts_with("source")) expected.push_back(entry);
  EXPECT_EQ(pushed.calls.entries(), expected);
}

TEST_P(PushedFrames, ComeBackAsReportsWithTheirPose) {
  Engine engine = this->engine();
  for (std::uint32_t i = 0; i < 9; ++i) {
    const FrameReportPtr report = engine.process(make_frame(i));
    ASSERT_NE(report, nullptr);
    EXPECT_EQ(report->frame->index, i);
    EXPECT_EQ(report->result.state, TrackState::kTracking);
    EXPECT_DOUBLE_EQ(report->result.world_from_camera.translation().x(), i);
  }
  engine.finish();
  EXPECT_EQ(f_.output->finished, 1);
  EXPECT_TRUE(f_.output->complete);
  EXPECT_EQ(f_.output->poses.size(), 9u);
  EXPECT_EQ(f_.output->source.skipped, 0u);
  EXPECT_EQ(engine.map()->keyframe_count(), 5u);
}

// The fake loop closer lifts what is in the map by a metre per key frame.
TEST_P(PushedFrames, TheTrajectoryFollowsTheMap) {
  Engine engine = this->engine();
  for (std::uint32_t i = 0; i < 9; ++i) engine.process(make_frame(i));
  engine.finish();
  const auto trajectory = engine.trajectory();
  ASSERT_EQ(trajectory.size(), 9u);
  EXPECT_DOUBLE_EQ(trajectory[4].time, 10.4);
  const Pose expected = engine.map()->world_from_keyframe(engine.poses()[5].reference) *
                        engine.poses()[5].reference_from_camera;
  EXPECT_TRUE(trajectory[5].world_from_camera.isApprox(expected));
  EXPECT_GE(trajectory[0].world_from_camera.translation().y(), 1.0);
}

TEST_P(PushedFrames, AreCountedAndGetTheirGreyImage) {
  Engine engine = this->engine();
  Frame frame = make_frame(77);
  frame.gray.release();
  const FrameReportPtr report = engine.process(std::move(frame));
  EXPECT_EQ(report->frame->index, 0u);
  EXPECT_EQ(report->frame->gray.type(), CV_8UC1);
}

TEST_P(PushedFrames, ThatCannotBeUsedCountForNothing) {
  Engine engine = this->engine();
  engine.process(make_frame(0));
  Frame millimetres = make_frame(1);
  millimetres.depth.convertTo(millimetres.depth, CV_16U);
  EXPECT_EQ(message_of([&] { engine.process(millimetres); }, Fault::kData),
            "frame 1: the depth image is of CV_16UC1; it must be of CV_32FC1");
  Frame earlier = make_frame(1);
  earlier.time = 9.0;
  EXPECT_EQ(message_of([&] { engine.process(earlier); }, Fault::kData),
            "frame 1: the frame is 1.000000 s older than the one before; give frames in order of "
            "time");
  const cv::Mat nothing(0, 0, CV_8UC3);
  EXPECT_EQ(message_of([&] { engine.process({.time = 20.0, .bgr = nothing}); }, Fault::kData),
            "frame 1: the frame has no image; leave out images that cannot be read");
  EXPECT_EQ(engine.process(make_frame(1))->frame->index, 1u);
  engine.finish();
  EXPECT_TRUE(f_.output->complete);
  EXPECT_EQ(f_.output->poses.size(), 2u);
}

TEST_P(PushedFrames, AFailureIsToldAndWhatWasComputedIsSaved) {
  f_.calls.failing = "decide 3";
  const char* expected = "decision (vote) failed on frame 3: out of ideas";
  {
    Engine engine = this->engine();
    for (std::uint32_t i = 0; i < 3; ++i) engine.process(make_frame(i));
    EXPECT_EQ(message_of([&] { engine.process(make_frame(3)); }, Fault::kStage), expected);
    EXPECT_EQ(message_of([&] { engine.process(make_frame(4)); }, Fault::kStage), expected);
    EXPECT_EQ(engine.trajectory().size(), 3u);
  }
  EXPECT_EQ(f_.output->finished, 1);
  EXPECT_EQ(f_.output->poses.size(), 3u);
  EXPECT_EQ(f_.output->failure, expected);
}

TEST_P(PushedFrames, AFailureOfMappingIsToldByALaterCall) {
  f_.calls.failing = "integrate 2";
  Engine engine = this->engine();
  const std::string message = message_of(
      [&] {
        for (std::uint32_t i = 0; i < 9; ++i) engine.process(make_frame(i));
        engine.finish();
      },
      Fault::kStage);
  EXPECT_EQ(message, "dense mapping (cloud) failed on frame 2: out of ideas");
}

TEST_P(PushedFrames, AnEngineThatIsLeftFinishesItsOutputs) {
  {
    Engine engine = this->engine();
    engine.process(make_frame(0));
  }
  EXPECT_EQ(f_.output->finished, 1);
  EXPECT_FALSE(f_.output->complete);
  EXPECT_EQ(f_.output->poses.size(), 1u);
}

TEST_P(PushedFrames, WithoutAnyAnOutputIsNotAskedToFinish) {
  Engine engine = this->engine();
  engine.finish();
  EXPECT_TRUE(f_.output->before_first_frame);
}

TEST_P(PushedFrames, AProgramOfAnotherLayoutIsRefused) {
  const std::string message = message_of(
      [&] { Engine(f_.stages(), runtime(GetParam()), {}, nullptr, "other"); }, Fault::kUsage);
  EXPECT_NE(message.find("the program was compiled with other, Stillpoint with libstdc++"),
            std::string::npos)
      << message;
}

TEST_P(PushedFrames, AreNotMixedWithRunsAndNotWantedAfterTheEnd) {
  Engine engine = this->engine();
  engine.process(make_frame(0));
  EXPECT_EQ(message_of([&] { engine.run(); }, Fault::kUsage),
            "run() can be called once, and not after process()");
  engine.finish();
  EXPECT_EQ(message_of([&] { engine.process(make_frame(1)); }, Fault::kUsage),
            "no frame can be pushed during run() or after finish()");
  EXPECT_EQ(message_of([&] { engine.finish(); }, Fault::kUsage), "the run is finished already");
}

TEST_P(PushedFrames, AKnownMapIsGoneOnWith) {
  Engine first = this->engine();
  for (std::uint32_t i = 0; i < 5; ++i) first.process(make_frame(i));
  first.finish();
  EngineFixture second;
  Stages stages = second.stages();
  stages.known_map = *first.map();
  Engine engine(std::move(stages), runtime(GetParam()), {});
  const FrameReportPtr report = engine.process(make_frame(0));
  ASSERT_TRUE(report->result.keyframe);
  EXPECT_EQ(report->result.keyframe->id, 3u);
}

}  // namespace
}  // namespace stillpoint
