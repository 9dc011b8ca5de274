#include "study/signed_rank.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

namespace stillpoint::study {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

// Differences of the ranks 1 … n, of which those in `negative` are below 0.
SignedRank of_ranks(int n, const std::vector<int>& negative) {
  std::vector<double> differences(static_cast<std::size_t>(n));
  std::iota(differences.begin(), differences.end(), 1.0);
  for (const int rank : negative) differences[static_cast<std::size_t>(rank - 1)] *= -1.0;
  return signed_rank(differences);
}

TEST(SignedRank, IsExactForFewPairs) {
  EXPECT_DOUBLE_EQ(of_ranks(5, {}).p, 2.0 / 32);
  EXPECT_DOUBLE_EQ(of_ranks(6, {}).p, 2.0 / 64);
  EXPECT_DOUBLE_EQ(of_ranks(6, {1}).p, 4.0 / 64);
  // Critical values of Wilcoxon's table, two-sided 5 %: the rank sums 8 for 10 pairs, 52 for 20.
  EXPECT_NEAR(of_ranks(10, {8}).p, 0.0488, 0.00005);
  EXPECT_GT(of_ranks(10, {9}).p, 0.05);
  EXPECT_LT(of_ranks(20, {20, 19, 13}).p, 0.05);
  EXPECT_GT(of_ranks(20, {20, 19, 14}).p, 0.05);
}

TEST(SignedRank, SidesAreTheSameUpToTheSign) {
  const SignedRank one = signed_rank(std::vector<double>{0.5, 0.1, -0.2, 0.9, 0.4, 0.3, 0.7});
  const SignedRank other =
      signed_rank(std::vector<double>{-0.5, -0.1, 0.2, -0.9, -0.4, -0.3, -0.7});
  EXPECT_DOUBLE_EQ(one.p, other.p);
  EXPECT_DOUBLE_EQ(one.effect, -other.effect);
  EXPECT_NEAR(one.effect, (26.0 - 2.0) / 28.0, 1e-12);
}

TEST(SignedRank, EqualDifferencesShareTheirMeanRank) {
  // Ranks 1.5, 1.5, 3, 4: of 16 choices of signs 1.5 or less has three.
  const SignedRank result = signed_rank(std::vector<double>{0.1, -0.1, 0.2, 0.3});
  EXPECT_DOUBLE_EQ(result.p, 6.0 / 16);
  EXPECT_NEAR(result.effect, 0.7, 1e-12);
}

TEST(SignedRank, NoDifferenceIsNoPair) {
  EXPECT_EQ(signed_rank(std::vector<double>{0.0, 0.0, 0.0}).p, 1.0);
  EXPECT_EQ(signed_rank({}).pairs, 0u);
  EXPECT_EQ(signed_rank(std::vector<double>{0.0, 1.0, 2.0}).pairs, 2u);
}

TEST(SignedRank, InfiniteOnesComeLast) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const SignedRank result = signed_rank(std::vector<double>{kInfinity, -0.1, 0.2, kInfinity, 0.3});
  EXPECT_DOUBLE_EQ(result.p, of_ranks(5, {1}).p);
}

TEST(SignedRank, ApproximationContinuesTheExactOne) {
  const std::vector<int> some = {1, 3, 6, 9, 12, 17, 22, 28, 31, 35, 38, 39, 42, 44, 47, 50};
  const double exact = of_ranks(50, some).p, approximate = of_ranks(51, some).p;
  EXPECT_NEAR(exact, 0.039016, 1e-6);         // of the sum 424, counted by another program
  EXPECT_NEAR(approximate, 0.024490, 0.001);  // the exact one
}

TEST(CorrectedForNumber, IsHolms) {
  const std::vector<double> p = {0.01, 0.04, 0.03, 0.005};
  EXPECT_THAT(corrected_for_number(p),
              ElementsAre(DoubleNear(0.03, 1e-12), DoubleNear(0.06, 1e-12), DoubleNear(0.06, 1e-12),
                          DoubleNear(0.02, 1e-12)));
  EXPECT_THAT(corrected_for_number(std::vector<double>{0.9, 0.8}), ElementsAre(1.0, 1.0));
  EXPECT_TRUE(corrected_for_number({}).empty());
}

TEST(SignedRank, NoPIsSmallerThanThatOfDifferencesOfOneSign) {
  std::vector<double> differences;
  EXPECT_DOUBLE_EQ(smallest_p(0), 1.0);
  for (std::size_t pairs = 1; pairs <= 12; ++pairs) {
    differences.push_back(static_cast<double>(pairs));
    EXPECT_DOUBLE_EQ(smallest_p(pairs), signed_rank(differences).p) << pairs;
  }
}

}  // namespace
}  // namespace stillpoint::study
