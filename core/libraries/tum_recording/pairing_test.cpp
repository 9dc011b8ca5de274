#include "tum_recording/pairing.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <tuple>

namespace stillpoint::tum_recording {
namespace {

using ::testing::ElementsAre;

/// What associate.py of the TUM benchmark does: all pairs, sorted by difference, greedily.
std::vector<IndexPair> reference(const std::vector<double>& color, const std::vector<double>& depth,
                                 double max_difference) {
  std::vector<std::tuple<double, std::size_t, std::size_t>> all;
  for (std::size_t c = 0; c < color.size(); ++c)
    for (std::size_t d = 0; d < depth.size(); ++d)
      if (std::abs(color[c] - depth[d]) < max_difference)
        all.emplace_back(std::abs(color[c] - depth[d]), c, d);
  std::sort(all.begin(), all.end());
  std::vector<bool> color_used(color.size()), depth_used(depth.size());
  std::vector<IndexPair> pairs;
  for (const auto& [difference, c, d] : all) {
    if (color_used[c] || depth_used[d]) continue;
    color_used[c] = depth_used[d] = true;
    pairs.push_back({c, d});
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const IndexPair& a, const IndexPair& b) { return a.color < b.color; });
  return pairs;
}

/// Increasing multiples of a quarter, so that differences are exact and often equal.
std::vector<double> random_stamps(std::mt19937& random, int count, int max_step) {
  std::vector<double> stamps;
  double time = 0;
  for (int i = 0; i < count; ++i) {
    time += 0.25 * std::uniform_int_distribution(1, max_step)(random);
    stamps.push_back(time);
  }
  return stamps;
}

TEST(PairByTime, EqualsTheExhaustiveSearch) {
  std::mt19937 random(1);
  for (int round = 0; round < 300; ++round) {
    const auto color = random_stamps(random, round % 40, 1 + round % 7);
    const auto depth = random_stamps(random, (round * 7) % 40, 1 + round % 5);
    for (const double max_difference : {0.25, 0.6, 2.0, 1000.0})
      EXPECT_EQ(pair_by_time(color, depth, max_difference), reference(color, depth, max_difference))
          << "round " << round << ", max_difference " << max_difference;
  }
}

TEST(PairByTime, TakesTheClosestPairFirst) {
  EXPECT_THAT(pair_by_time(std::vector{1.0, 2.0}, std::vector{1.875, 3.0}, 1.5),
              ElementsAre(IndexPair{1, 0}));
}

TEST(PairByTime, PairsNothingBeyondTheLimit) {
  EXPECT_TRUE(pair_by_time(std::vector{1.0}, std::vector{1.5}, 0.5).empty());
  EXPECT_TRUE(pair_by_time({}, {}, 1.0).empty());
}

}  // namespace
}  // namespace stillpoint::tum_recording
