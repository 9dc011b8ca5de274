#include "vote_decision.hpp"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <stillpoint/testing/test_recording.hpp>

namespace {

using stillpoint::testing::TestRecording;

constexpr std::size_t kFrames = 30;  // one second

/// Somebody walks through the picture.
const TestRecording& recording() {
  static const TestRecording recording({.frames = kFrames, .width = 160, .height = 120});
  return recording;
}

/// What a decision says of the person in frame i, whose points move or do not.
stillpoint::StaticWeights decide(VoteDecision& decision, std::size_t i, bool moving) {
  stillpoint::MovingPoints points = recording().moving_points(i);
  for (stillpoint::PointMotion& point : points.points) point.moving &= moving;
  return decision.decide(*recording().frame(i), *recording().segmentation(i), points, {});
}

VoteDecision decision() {
  return {VoteDecision::Options{.min_points = 2}, stillpoint::testing::test_context()};
}

cv::Mat person(std::size_t i) { return recording().segmentation(i)->labels != 0; }

TEST(VoteDecision, WhoWalksIsNeitherTrackedNorMapped) {
  VoteDecision vote = decision();
  for (std::size_t i = 5; i < 10; ++i) {
    const auto weights = decide(vote, i, true);
    EXPECT_TRUE(weights.object_moves.at(0));
    EXPECT_EQ(cv::countNonZero(weights.track & person(i)), 0);
    EXPECT_GT(cv::countNonZero(weights.track == 255), 0.7 * weights.track.total());
  }
}

TEST(VoteDecision, OneFrameWithoutMotionChangesNothingButASecondDoes) {
  VoteDecision vote = decision();
  decide(vote, 5, true);
  EXPECT_TRUE(decide(vote, 6, false).object_moves.at(0));
  stillpoint::StaticWeights weights;
  for (std::size_t i = 7; i < kFrames; ++i) weights = decide(vote, i, false);
  EXPECT_FALSE(weights.object_moves.at(0));
  EXPECT_EQ(cv::countNonZero(weights.track & person(kFrames - 1)),
            cv::countNonZero(person(kFrames - 1)));
  EXPECT_EQ(cv::countNonZero(weights.map & person(kFrames - 1)), 0);  // never mapped
}

TEST(VoteDecision, TheMapCheckAloneIsEnough) {
  VoteDecision vote({.classes = {{"person", {.prior = 0.0}}}}, stillpoint::testing::test_context());
  stillpoint::MapEvidence evidence;
  evidence.log_odds = cv::Mat(30, 40, CV_32F, cv::Scalar(3));  // free space was there before
  bool moves = false;
  for (std::size_t i = 5; i < 12; ++i)
    moves = vote.decide(*recording().frame(i), *recording().segmentation(i), {}, evidence)
                .object_moves.at(0);
  EXPECT_TRUE(moves);
}

TEST(VoteDecision, RefusesAClassThatTheSegmenterDoesNotHave) {
  EXPECT_THROW(VoteDecision({.classes = {{"unicorn", {}}}}, stillpoint::testing::test_context()),
               stillpoint::Error);
}

}  // namespace
