#include "people/walk.hpp"

#include <gtest/gtest.h>

namespace stillpoint::people {
namespace {

TEST(Walk, GoesFromPlaceToPlaceAgainAndAgain) {
  const PersonPlan plan{.walk = {0, -1, 2, 4, 1, 2, 8, -1, 2}};
  EXPECT_NEAR(stance_at(plan, 2).foot.x(), 0, 1e-9);
  EXPECT_FALSE(stance_at(plan, 2).to_the_left);
  EXPECT_TRUE(stance_at(plan, 6).to_the_left);
  EXPECT_NEAR(stance_at(plan, 18).foot.x(), stance_at(plan, 2).foot.x(), 1e-9);
  PersonPlan once = plan;
  once.again = false;
  EXPECT_NEAR(stance_at(once, 18).foot.x(), -1, 1e-9);
}

TEST(Walk, LegsRestWithTheRest) {
  const PersonPlan plan{.walk = {0, -1, 2, 2, 0, 2, 10, 0, 2}, .again = false};
  EXPECT_EQ(stance_at(plan, 1).walking, 1);
  EXPECT_EQ(stance_at(plan, 5).walking, 0);
  EXPECT_EQ(stance_at(plan, 5).stride, stance_at(plan, 9).stride);
  EXPECT_FALSE(stance_at(plan, 5).to_the_left);  // where they came from
}

TEST(Walk, SittingDownAndStandingUpTakeTime) {
  const PersonPlan plan{.walk = {0, 0, 2}, .sits = {1, 9}};
  EXPECT_EQ(stance_at(plan, 0.5).seated, 0);
  EXPECT_EQ(stance_at(plan, 5).seated, 1);
  EXPECT_GT(stance_at(plan, 8.5).seated, 0);
  EXPECT_LT(stance_at(plan, 8.5).seated, 1);
  EXPECT_EQ(stance_at(plan, 9.5).seated, 0);
}

}  // namespace
}  // namespace stillpoint::people
