#include "live_camera/live_pairs.hpp"

#include <gtest/gtest.h>

#include <stop_token>
#include <thread>

namespace stillpoint::live_camera {
namespace {

using namespace std::chrono_literals;

cv::Mat image(int value) { return {1, 1, CV_16UC1, cv::Scalar(value)}; }
int value_of(const cv::Mat& image) { return image.at<std::uint16_t>(0, 0); }

TEST(LivePairs, PairsWhatIsCloseInTimeInEitherOrder) {
  LivePairs pairs(0.02);
  pairs.put_color(1.000, image(1));
  pairs.put_depth(1.010, image(11));
  pairs.put_depth(1.040, image(12));
  pairs.put_color(1.033, image(2));
  for (const int i : {1, 2}) {
    const auto pair = pairs.take(0ms);
    ASSERT_TRUE(pair);
    EXPECT_EQ(value_of(pair->bgr), i);
    EXPECT_EQ(value_of(pair->depth), 10 + i);
    EXPECT_DOUBLE_EQ(pair->seconds, i == 1 ? 1.000 : 1.033);
  }
  EXPECT_FALSE(pairs.take(0ms));
  EXPECT_EQ(pairs.unpaired(), 0u);
}

TEST(LivePairs, TakesTheClosestAndCountsWhatIsLeftOver) {
  LivePairs pairs(0.02);
  pairs.put_depth(0.990, image(11));
  pairs.put_depth(1.001, image(12));
  pairs.put_color(1.000, image(1));
  EXPECT_EQ(value_of(pairs.take(0ms)->depth), 12);
  EXPECT_EQ(pairs.unpaired(), 1u);
}

// The depth image of a lost colour image is within 20 ms of the next one.
TEST(LivePairs, ALostImageShiftsNoPairsOfSixtyHertz) {
  LivePairs pairs(0.02);
  int given = 0;
  for (int i = 0; i < 60; ++i) {
    if (i != 20) pairs.put_color(i / 60.0, image(i));
    pairs.put_depth(i / 60.0 + 0.004, image(i));
    while (const auto pair = pairs.take(0ms)) {
      ++given;
      EXPECT_EQ(value_of(pair->bgr), value_of(pair->depth));
    }
  }
  EXPECT_EQ(given, 59);
}

// Depth comes first, while the colour image in between waits.
TEST(LivePairs, PairsStreamsOfTwoRates) {
  LivePairs pairs(0.02);
  for (int i = 0; i < 20; ++i) {
    if (i % 2 == 0) pairs.put_depth(i / 60.0, image(i));
    pairs.put_color(i / 60.0, image(i));
    const auto pair = pairs.take(0ms);
    ASSERT_EQ(pair.has_value(), i % 2 == 0) << i;
    if (!pair) continue;
    EXPECT_EQ(value_of(pair->bgr), value_of(pair->depth));
  }
}

// The colour and depth images of a Kinect are taken independently of each other.
TEST(LivePairs, PairsThoseThatAreHalfAnIntervalApart) {
  LivePairs pairs(0.02);
  int given = 0;
  for (int i = 0; i < 60; ++i) {
    pairs.put_color(i / 30.0, image(i));
    pairs.put_depth(i / 30.0 + (i % 2 == 0 ? 0.015 : 0.018), image(i));
    while (pairs.take(0ms)) ++given;
  }
  EXPECT_EQ(given, 60);
}

TEST(LivePairs, PairsNothingThatIsFarApart) {
  LivePairs pairs(0.02);
  for (int i = 0; i < 10; ++i) {
    pairs.put_color(i, image(i));
    pairs.put_depth(i + 0.5, image(i));
  }
  EXPECT_FALSE(pairs.take(0ms));
  EXPECT_EQ(pairs.unpaired(), 12u);  // four of each kind still wait
}

TEST(LivePairs, DropsTheOldestWhenNobodyTakesThem) {
  LivePairs pairs(0.02);
  for (int i = 0; i < 5; ++i) {
    pairs.put_color(i, image(i));
    pairs.put_depth(i, image(i));
  }
  EXPECT_EQ(pairs.dropped(), 3u);
  EXPECT_EQ(value_of(pairs.take(0ms)->bgr), 3);
  EXPECT_EQ(value_of(pairs.take(0ms)->bgr), 4);
}

TEST(LivePairs, WaitsForThePair) {
  LivePairs pairs(0.02);
  std::jthread driver([&] {
    pairs.put_depth(1, image(1));
    pairs.put_color(1, image(1));
  });
  EXPECT_TRUE(pairs.take(60s));
}

TEST(LivePairs, GivesWhatWaitsBeforeTheEnd) {
  LivePairs pairs(0.02);
  pairs.put_depth(1, image(1));
  pairs.put_color(1, image(1));
  pairs.end("unplugged");
  pairs.end("closed");
  EXPECT_TRUE(pairs.take(60s));
  EXPECT_FALSE(pairs.take(60s));
  EXPECT_EQ(pairs.why_ended(), "unplugged");
}

TEST(LivePairs, AStopEndsTheWait) {
  LivePairs pairs(0.02);
  std::stop_source stop;
  std::jthread user([&] { stop.request_stop(); });
  EXPECT_FALSE(pairs.take(1h, stop.get_token()));
}

TEST(LivePairs, BeginAnew) {
  LivePairs pairs(0.02);
  pairs.put_depth(1, image(1));
  pairs.end("unplugged");
  pairs.restart();
  EXPECT_EQ(pairs.why_ended(), "");
  EXPECT_EQ(pairs.unpaired(), 1u);
  pairs.put_color(1, image(1));  // its partner is of the time before
  EXPECT_FALSE(pairs.take(0ms));
  pairs.put_depth(1.005, image(2));
  EXPECT_EQ(value_of(pairs.take(0ms)->depth), 2);
}

}  // namespace
}  // namespace stillpoint::live_camera
