#include "ros2/missing_frames.hpp"

#include <gtest/gtest.h>

namespace stillpoint::ros2 {
namespace {

TEST(MissingFrames, AreCountedByTheShorterIntervals) {
  MissingFrames frames;
  for (const int i : {0, 2, 4, 5, 7, 9, 10, 12, 14, 16}) frames.add(7.0 + i / 30.0);
  EXPECT_EQ(frames.count(), 7U);
  MissingFrames few;
  for (const int i : {0, 1, 20}) few.add(i / 30.0);
  EXPECT_EQ(few.count(), 0U);
}

}  // namespace
}  // namespace stillpoint::ros2
