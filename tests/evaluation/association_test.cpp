#include "evaluation/association.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace stillpoint::evaluation {
namespace {

TEST(Association, ClosestPairsComeFirstAndEachStampIsUsedOnce) {
  const std::vector<double> first = {0.00, 0.10, 0.20}, second = {0.015, 0.09, 0.109};
  const std::vector<TimePair> pairs = associate(first, second, 0.02, 0);
  ASSERT_EQ(pairs.size(), 2u);
  EXPECT_EQ(pairs[0].second, 0u);
  EXPECT_EQ(pairs[1].first, 1u);
  EXPECT_EQ(pairs[1].second, 2u);  // 0.109 is closer to 0.10 than 0.09 is
}

TEST(Association, OffsetIsAddedToTheSecondList) {
  const std::vector<double> first = {10, 11, 12}, second = {0, 1, 2};
  EXPECT_EQ(associate(first, second, 0.02, 0).size(), 0u);
  EXPECT_EQ(associate(first, second, 0.02, 10.01).size(), 3u);
}

TEST(Association, DifferenceMustBeSmallerThanTheLimit) {
  const std::vector<double> first = {1.0}, second = {1.5};
  EXPECT_TRUE(associate(first, second, 0.5, 0).empty());
  EXPECT_EQ(associate(first, second, 0.5001, 0).size(), 1u);
}

TEST(Association, EmptyListsGiveNoPairs) { EXPECT_TRUE(associate({}, {}, 0.02, 0).empty()); }

TEST(Association, ClosestElementIsFoundBetweenAndBeyondTheEnds) {
  const std::vector<double> rising = {1, 2, 4, 8};
  EXPECT_EQ(closest(rising, -5), 0u);
  EXPECT_EQ(closest(rising, 2), 1u);
  EXPECT_EQ(closest(rising, 2.9), 1u);
  EXPECT_EQ(closest(rising, 3.1), 2u);
  EXPECT_EQ(closest(rising, 99), 3u);
}

}  // namespace
}  // namespace stillpoint::evaluation
