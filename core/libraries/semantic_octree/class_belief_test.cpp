#include "semantic_octree/class_belief.hpp"

#include <gtest/gtest.h>

#include <random>

namespace stillpoint::semantic_octree {
namespace {

TEST(ClassBelief, TheMostFrequentClassWins) {
  std::mt19937 random(1);
  ClassBelief belief;
  EXPECT_FALSE(belief.known());
  EXPECT_EQ(belief.confidence(), 0.0);
  // Seven of ten observations say 5; the others any of 20 classes.
  for (int i = 0; i < 1000; ++i)
    belief.add(random() % 10 < 7 ? 5 : static_cast<std::uint8_t>(random() % 20));
  EXPECT_EQ(belief.best(), 5);
  EXPECT_NEAR(belief.confidence(), 0.7, 0.1);
}

TEST(ClassBelief, ItCanChange) {
  ClassBelief belief;
  for (int i = 0; i < 10; ++i) belief.add(3);
  EXPECT_EQ(belief.confidence(), 1.0);
  for (int i = 0; i < 11; ++i) belief.add(8);
  EXPECT_EQ(belief.best(), 8);
  EXPECT_LT(belief.confidence(), 0.6);
}

}  // namespace
}  // namespace stillpoint::semantic_octree
