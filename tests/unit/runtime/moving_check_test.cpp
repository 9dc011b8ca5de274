#include "stillpoint/runtime/moving_check.hpp"

#include <gtest/gtest.h>

#include "doubles.hpp"

namespace stillpoint {
namespace {

using testing::Journal;
using Strings = std::vector<std::string>;

MovingPoints check(MovingCheck& stage, std::uint32_t index) {
  return stage.at(std::make_shared<const Frame>(testing::make_frame(index)));
}

TEST(MovingCheck, ComparesEachFrameWithTheOneBefore) {
  Journal journal;
  TimeLog times;
  MovingCheck stage({std::make_shared<testing::FakeChecker>(journal), "lk"}, times);
  for (std::uint32_t i = 0; i < 3; ++i) EXPECT_EQ(check(stage, i).reliable, i > 0);
  EXPECT_EQ(journal.entries("check"), (Strings{"check 0 1", "check 1 2"}));
  EXPECT_EQ(times.take().size(), 2u);
}

TEST(MovingCheck, AFailureIsNamed) {
  Journal journal;
  TimeLog times;
  journal.failing = "check 0 1";
  MovingCheck stage({std::make_shared<testing::FakeChecker>(journal), "lk"}, times);
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
  MovingCheck stage({}, times);
  EXPECT_FALSE(stage.present());
  for (std::uint32_t i = 0; i < 2; ++i) EXPECT_TRUE(check(stage, i).points.empty());
  EXPECT_TRUE(times.take().empty());
}

}  // namespace
}  // namespace stillpoint
