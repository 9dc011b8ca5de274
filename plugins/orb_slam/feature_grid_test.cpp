#include "orb_slam/feature_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

std::vector<std::uint32_t> near(const FeatureGrid& grid, double u, double v, double radius) {
  std::vector<std::uint32_t> found;
  grid.for_each_near(u, v, radius, [&](std::uint32_t i) { found.push_back(i); });
  std::sort(found.begin(), found.end());
  return found;
}

std::vector<std::uint32_t> near_by_comparing_all(const Features& features, double u, double v,
                                                 double radius) {
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < features.size(); ++i) {
    const cv::Point2f p = features.keypoints[i].pt;
    if (std::abs(p.x - u) <= radius && std::abs(p.y - v) <= radius) found.push_back(i);
  }
  return found;
}

TEST(FeatureGrid, FindsWhatComparingAllFinds) {
  TestWorld random(0);
  Features features;
  const Camera camera;
  for (int i = 0; i < 1000; ++i)
    features.keypoints.emplace_back(static_cast<float>(random.uniform(0, camera.width - 1)),
                                    static_cast<float>(random.uniform(0, camera.height - 1)), 31.f);
  const FeatureGrid grid(features, camera);
  for (int i = 0; i < 500; ++i) {  // windows across the border and outside included
    const double u = random.uniform(-100, camera.width + 100);
    const double v = random.uniform(-100, camera.height + 100);
    const double radius = random.uniform(0, 80);
    EXPECT_EQ(near(grid, u, v, radius), near_by_comparing_all(features, u, v, radius));
  }
}

TEST(FeatureGrid, HoldsFeaturesInTheCornersOfTheImage) {
  const Camera camera;
  Features features;
  for (const float u : {0.f, camera.width - 1.f})
    for (const float v : {0.f, camera.height - 1.f}) features.keypoints.emplace_back(u, v, 31.f);
  const FeatureGrid grid(features, camera);
  EXPECT_THAT(near(grid, 0, 0, 0), testing::ElementsAre(0));
  EXPECT_THAT(near(grid, camera.width - 1, camera.height - 1, 0), testing::ElementsAre(3));
  EXPECT_EQ(near(grid, 320, 240, 1000).size(), 4u);
}

TEST(FeatureGrid, WithoutFeaturesFindsNothing) {
  EXPECT_TRUE(near(FeatureGrid(Features{}, Camera{}), 320, 240, 1000).empty());
  EXPECT_TRUE(near(FeatureGrid(), 320, 240, 1000).empty());
}

}  // namespace
}  // namespace stillpoint::orb_slam
