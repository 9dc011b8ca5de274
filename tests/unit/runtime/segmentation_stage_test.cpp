#include "stillpoint/runtime/segmentation_stage.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <latch>
#include <thread>

#include "doubles.hpp"

namespace stillpoint {
namespace {

using testing::CallLog;
using Schedule = SegmentationOptions::Schedule;
using Strings = std::vector<std::string>;

struct SegmentationFixture {
  CallLog calls;
  StopSignal stop;
  TimeLog times;

  using OnFailure = SegmentationOptions::OnFailure;

  std::unique_ptr<SegmentationStage> make(Schedule schedule, Mode mode, double latency = 0.3,
                                          OnFailure on_failure = OnFailure::kStop) {
    return make({.schedule = schedule, .latency_seconds = latency, .on_failure = on_failure}, mode);
  }
  std::unique_ptr<SegmentationStage> make(const SegmentationOptions& options, Mode mode) {
    return std::make_unique<SegmentationStage>(
        Stage<Segmenter>{std::make_shared<testing::FakeSegmenter>(calls), "fake"},
        Stage<Propagator>{std::make_shared<testing::FakePropagator>(calls), "fake"}, options, mode,
        stop, times);
  }
};

SegmentationPtr process(SegmentationStage& stage, std::uint32_t index) {
  const auto frame = std::make_shared<const Frame>(testing::make_frame(index));
  stage.offer(frame);
  return stage.labels_for(frame);
}

TEST(SegmentationStage, WaitGivesEveryFrameItsOwnLabels) {
  for (const Mode mode : {Mode::kInline, Mode::kThreaded}) {
    SegmentationFixture f;
    const auto stage = f.make(Schedule::kWait, mode);
    for (std::uint32_t i = 0; i < 5; ++i) {
      const auto labels = process(*stage, i);
      ASSERT_TRUE(labels && labels->known());
      EXPECT_EQ(labels->frame, i);
    }
    EXPECT_EQ(f.calls.entries("propagate 4"), (Strings{"propagate 4 4"}));
  }
}

TEST(SegmentationStage, LatestInlineImitatesABusyNetwork) {
  SegmentationFixture f;
  const auto stage = f.make(Schedule::kLatest, Mode::kInline, 0.3);
  for (std::uint32_t i = 0; i <= 8; ++i) EXPECT_TRUE(process(*stage, i)->known());
  // The first labels are waited for. Frame 1 takes until 4; of those that came meanwhile, the
  // newest is next and takes until 7.
  EXPECT_EQ(
      f.calls.entries("propagate"),
      (Strings{"propagate 0 0", "propagate 0 1", "propagate 0 2", "propagate 0 3", "propagate 1 4",
               "propagate 1 5", "propagate 1 6", "propagate 4 7", "propagate 4 8"}));
  EXPECT_EQ(f.calls.entries("segment"), (Strings{"segment 0", "segment 1", "segment 4"}));
}

TEST(SegmentationStage, LatestInlineWithoutLatencyIsWait) {
  SegmentationFixture f;
  const auto stage = f.make(Schedule::kLatest, Mode::kInline, 0);
  for (std::uint32_t i = 0; i < 4; ++i) process(*stage, i);
  EXPECT_EQ(f.calls.entries("propagate"),
            (Strings{"propagate 0 0", "propagate 1 1", "propagate 2 2", "propagate 3 3"}));
}

TEST(SegmentationStage, LatestInlineTakesAFrameEveryInterval) {
  SegmentationFixture f;
  const auto stage =
      f.make({.schedule = Schedule::kLatest, .interval_seconds = 0.3, .latency_seconds = 0.1},
             Mode::kInline);
  for (std::uint32_t i = 0; i <= 7; ++i) process(*stage, i);
  EXPECT_EQ(f.calls.entries("propagate"),
            (Strings{"propagate 0 0", "propagate 0 1", "propagate 0 2", "propagate 0 3",
                     "propagate 3 4", "propagate 3 5", "propagate 3 6", "propagate 6 7"}));
}

TEST(SegmentationStage, AnIntervalShorterThanTheNetworkTakesChangesNothing) {
  SegmentationFixture f;
  const auto stage =
      f.make({.schedule = Schedule::kLatest, .interval_seconds = 0.2, .latency_seconds = 0.3},
             Mode::kInline);
  for (std::uint32_t i = 0; i <= 8; ++i) process(*stage, i);
  EXPECT_EQ(f.calls.entries("segment"), (Strings{"segment 0", "segment 2", "segment 5"}));
}

TEST(SegmentationStage, LatestThreadedTakesAFrameEveryInterval) {
  SegmentationFixture f;
  const auto stage =
      f.make({.schedule = Schedule::kLatest, .interval_seconds = 0.3}, Mode::kThreaded);
  for (std::uint32_t i = 0; i <= 8; ++i) {
    process(*stage, i);
    if (i % 3 == 0) f.calls.wait_for("segment " + std::to_string(i));
  }
  stage->end();
  EXPECT_EQ(f.calls.entries("segment"), (Strings{"segment 0", "segment 3", "segment 6"}));
}

TEST(SegmentationStage, LatestThreadedABusyNetworkGoesOnWithTheNewest) {
  SegmentationFixture f;
  std::latch release(1);
  f.calls.hook = [&](const std::string& entry) {
    if (entry == "segment 2") release.wait();
  };
  const auto stage =
      f.make({.schedule = Schedule::kLatest, .interval_seconds = 0.2}, Mode::kThreaded);
  for (std::uint32_t i = 0; i <= 2; ++i) process(*stage, i);
  f.calls.wait_for("segment 2");
  for (std::uint32_t i = 3; i <= 7; ++i) process(*stage, i);
  release.count_down();
  stage->end();
  EXPECT_EQ(f.calls.entries("segment"), (Strings{"segment 0", "segment 2", "segment 7"}));
}

TEST(SegmentationStage, WaitGivesEveryFrameItsLabelsWhateverTheInterval) {
  SegmentationFixture f;
  const auto stage =
      f.make({.schedule = Schedule::kWait, .interval_seconds = 0.3}, Mode::kThreaded);
  for (std::uint32_t i = 0; i < 4; ++i) EXPECT_EQ(process(*stage, i)->frame, i);
}

TEST(SegmentationStage, LatestThreadedNeverWaitsForABusyNetwork) {
  SegmentationFixture f;
  std::latch release(1);
  f.calls.hook = [&](const std::string& entry) {
    if (entry == "segment 1") release.wait();
  };
  const auto stage = f.make(Schedule::kLatest, Mode::kThreaded);
  process(*stage, 0);
  const auto first = std::make_shared<const Frame>(testing::make_frame(1));
  stage->offer(first);
  f.calls.wait_for("segment 1");
  stage->labels_for(first);
  for (std::uint32_t i = 2; i < 6; ++i) EXPECT_TRUE(process(*stage, i)->known());
  EXPECT_TRUE(f.calls.contains("propagate 0 5"));
  release.count_down();
  stage->end();
  EXPECT_EQ(f.calls.entries("segment"), (Strings{"segment 0", "segment 1", "segment 5"}));
}

TEST(SegmentationStage, WithoutSegmenterNothingIsKnown) {
  StopSignal stop;
  TimeLog times;
  SegmentationStage stage({}, {}, {}, Mode::kThreaded, stop, times);
  const auto labels = process(stage, 0);
  ASSERT_TRUE(labels);
  EXPECT_FALSE(labels->known());
  EXPECT_TRUE(times.take().empty());
}

TEST(SegmentationStage, AFailureEndsTheWait) {
  SegmentationFixture f;
  f.calls.failing = "segment 0";
  const auto stage = f.make(Schedule::kWait, Mode::kThreaded);
  EXPECT_EQ(process(*stage, 0), nullptr);
  try {
    std::rethrow_exception(f.stop.failure());
  } catch (const StageError& error) {
    EXPECT_STREQ(error.what(), "segmentation (fake) failed on frame 0: out of ideas");
  }
}

TEST(SegmentationStage, OnFailureContinueGoesOnWithoutLabelsAndCounts) {
  for (const Mode mode : {Mode::kInline, Mode::kThreaded}) {
    SegmentationFixture f;
    f.calls.failing = "segment 1";
    const auto stage = f.make(Schedule::kWait, mode, 3, SegmentationOptions::OnFailure::kContinue);
    EXPECT_TRUE(process(*stage, 0)->known());
    EXPECT_FALSE(process(*stage, 1)->known());
    EXPECT_TRUE(process(*stage, 2)->known());
    stage->end();
    EXPECT_EQ(stage->failures(), 1);
    EXPECT_EQ(stage->unlabelled(), 1);
    EXPECT_EQ(stage->first_failure(), "segmentation (fake) failed on frame 1: out of ideas");
    EXPECT_FALSE(f.stop.failure());
  }
}

class Careless final : public Segmenter {
 public:
  explicit Careless(Segmentation given) : given_(std::move(given)) {}
  ClassNames classes() const override { return named_classes("voc21"); }
  Segmentation segment(const Frame&) override { return given_; }

 private:
  Segmentation given_;
};

TEST(SegmentationStage, OneClassOnNearlyTheWholeImageIsNotUsed) {
  const auto used = [](int rows_of_people) {
    SegmentationFixture f;
    cv::Mat labels = cv::Mat::zeros(10, 1, CV_8UC1);
    labels.rowRange(0, rows_of_people) = 15;
    SegmentationStage stage({std::make_shared<Careless>(Segmentation{.labels = labels}), "fake"},
                            {}, {.max_labelled = 0.9}, Mode::kInline, f.stop, f.times);
    Frame frame = testing::make_frame(0);
    frame.gray = cv::Mat::zeros(10, 1, CV_8UC1);
    const auto shared = std::make_shared<const Frame>(std::move(frame));
    stage.offer(shared);
    return stage.labels_for(shared)->known();
  };
  EXPECT_TRUE(used(9));
  EXPECT_FALSE(used(10));
}

TEST(SegmentationStage, LabelsThatDoNotFitTheFrameAreTheSegmentersFault) {
  const auto message = [](Segmentation given) -> std::string {
    SegmentationFixture f;
    SegmentationStage stage({std::make_shared<Careless>(std::move(given)), "careless"}, {}, {},
                            Mode::kInline, f.stop, f.times);
    try {
      process(stage, 0);
    } catch (const StageError& error) {
      return error.what();
    }
    return "";
  };
  const cv::Mat pixel(1, 1, CV_8UC1, cv::Scalar(1)), small(3, 4, CV_8UC1, cv::Scalar(0));
  EXPECT_EQ(message({.labels = small}),
            "segmentation (careless) failed on frame 0: the labels have 4 x 3 pixels, but the "
            "frame has 1 x 1; give one byte per pixel of the frame");
  EXPECT_THAT(message({.labels = cv::Mat(1, 1, CV_32FC1, cv::Scalar(1))}),
              ::testing::HasSubstr("the labels are of CV_32FC1"));
  EXPECT_THAT(message({.labels = pixel, .instances = small}),
              ::testing::HasSubstr("the instances"));
  EXPECT_THAT(message({.labels = pixel, .instances = pixel}),
              ::testing::HasSubstr("belongs to object 1 of 0"));
  EXPECT_EQ(message({.labels = pixel, .instances = pixel, .objects = {{.label = 1, .pixels = 1}}}),
            "");
}

TEST(SegmentationStage, TimesNameTheirFrame) {
  SegmentationFixture f;
  const auto stage = f.make(Schedule::kWait, Mode::kThreaded);
  process(*stage, 7);
  stage->end();
  std::vector<std::string> stages;
  for (const StageTime& time : f.times.take()) {
    EXPECT_EQ(time.frame, 7u);
    stages.push_back(time.stage);
  }
  std::sort(stages.begin(), stages.end());
  EXPECT_EQ(stages, (Strings{"propagate", "segmentation", "segmentation_wait"}));
}

}  // namespace
}  // namespace stillpoint
