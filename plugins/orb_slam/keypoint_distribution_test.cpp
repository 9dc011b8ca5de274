#include "orb_slam/keypoint_distribution.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <set>

namespace stillpoint::orb_slam {
namespace {

const cv::Size kImage(320, 240);

std::vector<Corner> random_corners(int count, cv::Rect region, int max_score) {
  cv::RNG random(3);
  std::set<std::pair<int, int>> places;
  while (std::ssize(places) < count)
    places.insert(
        {random.uniform(region.y, region.br().y), random.uniform(region.x, region.br().x)});
  std::vector<Corner> corners;
  for (const auto& [y, x] : places) corners.push_back({x, y, random.uniform(8, max_score)});
  return corners;
}

TEST(DropWeakBesideStrong, DecidesCellByCell) {
  std::vector<Corner> corners = {{5, 5, 30}, {9, 9, 20}, {40, 5, 20}, {45, 9, 8}, {319, 239, 9}};
  drop_weak_beside_strong(corners, kImage, 32, 20);
  EXPECT_EQ(corners, (std::vector<Corner>{{5, 5, 30}, {40, 5, 20}, {45, 9, 8}, {319, 239, 9}}));
}

TEST(KeepEvenlySpread, KeepsEverythingWhenThereIsLittle) {
  std::vector<Corner> corners = {{1, 1, 9}, {2, 2, 10}};
  keep_evenly_spread(corners, kImage, 2);
  EXPECT_EQ(corners, (std::vector<Corner>{{2, 2, 10}, {1, 1, 9}}));
  corners.clear();
  keep_evenly_spread(corners, kImage, 2);
  EXPECT_TRUE(corners.empty());
}

TEST(KeepEvenlySpread, KeepsTheStrongestOfOne) {
  std::vector<Corner> corners = random_corners(500, {0, 0, 320, 240}, 100);
  const auto strongest =
      *std::max_element(corners.begin(), corners.end(),
                        [](const Corner& a, const Corner& b) { return a.score < b.score; });
  keep_evenly_spread(corners, kImage, 1);
  ASSERT_EQ(corners.size(), 1U);
  EXPECT_EQ(corners[0].score, strongest.score);
}

TEST(KeepEvenlySpread, MeetsTheCountInDescendingOrder) {
  for (const int count : {0, 1, 2, 7, 50, 300, 499}) {
    std::vector<Corner> corners = random_corners(500, {0, 0, 320, 240}, 100);
    keep_evenly_spread(corners, kImage, count);
    EXPECT_EQ(std::ssize(corners), count);
    EXPECT_TRUE(std::is_sorted(corners.begin(), corners.end(),
                               [](const auto& a, const auto& b) { return a.score > b.score; }));
  }
}

// Strong corners crowd in one corner of the image, weak ones are everywhere.
TEST(KeepEvenlySpread, CoversWeakRegionsToo) {
  std::vector<Corner> corners = random_corners(1000, {0, 0, 320, 240}, 20);
  for (const Corner& c : random_corners(1000, {0, 0, 80, 60}, 20))
    corners.push_back({c.x, c.y, c.score + 100});
  keep_evenly_spread(corners, kImage, 192);
  std::set<std::pair<int, int>> cells;  // 40 px: 48 cells, 4 corners each
  for (const Corner& c : corners) cells.insert({c.x / 40, c.y / 40});
  EXPECT_GE(cells.size(), 47U);
  const auto crowded = std::count_if(corners.begin(), corners.end(),
                                     [](const Corner& c) { return c.x < 80 && c.y < 60; });
  EXPECT_LT(crowded, 40);  // 12 would be their share, 192 the strongest of all
}

TEST(KeepEvenlySpread, CornersDoNotTouch) {
  std::vector<Corner> corners = random_corners(3000, {0, 0, 320, 240}, 200);
  keep_evenly_spread(corners, kImage, 200);
  int closest = 1000;
  for (std::size_t i = 0; i < corners.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      closest = std::min(closest, std::max(std::abs(corners[i].x - corners[j].x),
                                           std::abs(corners[i].y - corners[j].y)));
  EXPECT_GE(closest, 8);  // an even grid would have 19.6
}

}  // namespace
}  // namespace stillpoint::orb_slam
