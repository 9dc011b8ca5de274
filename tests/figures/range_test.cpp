#include "figures/range.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stillpoint::figures {
namespace {

using ::testing::ElementsAre;

std::vector<std::string> texts_of(const Range& range, double count) {
  std::vector<std::string> texts;
  for (const Tick& tick : ticks_of(range, count)) texts.push_back(tick.text);
  return texts;
}

TEST(Ticks, AreRoundNumbersWithAsManyDecimalsAsTheStepNeeds) {
  EXPECT_THAT(texts_of({0, 1}, 5), ElementsAre("0.0", "0.2", "0.4", "0.6", "0.8", "1.0"));
  EXPECT_THAT(texts_of({0.1, 31}, 3), ElementsAre("10", "20", "30"));
  EXPECT_THAT(texts_of({1.386, 1.414}, 3), ElementsAre("1.39", "1.40", "1.41"));
  EXPECT_THAT(texts_of({0, 98'000}, 2), ElementsAre("0", "50000"));
}

TEST(Ticks, NegativeOnesHaveAMinusAndZeroHasNone) {
  EXPECT_THAT(texts_of({-0.52, 0.3}, 3), ElementsAre("−0.4", "−0.2", "0.0", "0.2"));
}

TEST(Ticks, IncludeTheEndsInSpiteOfRounding) {
  EXPECT_THAT(texts_of({0.1, 0.1 + 0.2}, 2), ElementsAre("0.1", "0.2", "0.3"));
}

TEST(Ticks, ComeAsCloseToTheWantedCountAsRoundStepsAllow) {
  for (const double span : {0.0123, 0.4, 1.0, 7.7, 31.0, 990.0, 123'456.0})
    for (const double count : {3.0, 6.0, 12.0}) {
      const std::size_t ticks = ticks_of({0.37 * span, 1.37 * span}, count).size();
      EXPECT_GE(static_cast<double>(ticks), 0.6 * count - 1) << span;
      EXPECT_LE(static_cast<double>(ticks), 1.6 * count + 1) << span;
    }
}

TEST(Ticks, OfAbsurdNumbersStayShort) {
  for (const Tick& tick : ticks_of({0, 1e250}, 4)) EXPECT_LT(tick.text.size(), 10u);
}

}  // namespace
}  // namespace stillpoint::figures
