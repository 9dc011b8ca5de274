#include "output_web/truth.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "support/recording_writer.hpp"

namespace stillpoint::output_web {
namespace {

namespace fs = std::filesystem;

TEST(Truth, IsBetweenItsNeighbours) {
  const Truth truth({1.0, 1.05, 3.0}, {{0, 0, 0}, {1, 2, 3}, {9, 9, 9}});
  EXPECT_TRUE(truth.position_at(1.0)->isApprox(Eigen::Vector3d(0, 0, 0)));
  EXPECT_TRUE(truth.position_at(1.025)->isApprox(Eigen::Vector3d(0.5, 1, 1.5)));
  EXPECT_FALSE(truth.position_at(0.9));
  EXPECT_FALSE(truth.position_at(2.0));  // a gap
  EXPECT_FALSE(truth.position_at(3.1));
  EXPECT_FALSE(Truth().known());
}

TEST(Truth, FitsUpToARigidMotion) {
  const Pose motion = Eigen::Translation3d(1, -2, 3) *
                      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized());
  const std::vector<Eigen::Vector3d> truth = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 2}};
  std::vector<Eigen::Vector3d> estimate;
  for (const Eigen::Vector3d& point : truth) estimate.emplace_back(motion * point);
  const auto fit = fit_truth(truth, estimate);
  ASSERT_TRUE(fit);
  EXPECT_TRUE(fit->world_from_truth.isApprox(motion, 1e-9));
  EXPECT_NEAR(fit->rmse_m, 0, 1e-9);
  EXPECT_FALSE(fit_truth({{0, 0, 0}, {1, 0, 0}}, {{0, 0, 0}, {1, 0, 0}}));
}

TEST(Truth, ComesFromTheRecording) {
  const testing::TemporaryFolder temporary;
  const fs::path& folder = temporary.path();
  std::ofstream(folder / "groundtruth.txt")
      << "# time tx ty tz qx qy qz qw\n2 1 1 1 0 0 0 1\nno pose\n1 nan 0 0\n1 0 0 0 0 0 0 1\n";
  EXPECT_TRUE(Truth::beside(folder).position_at(1)->isZero());
  EXPECT_TRUE(Truth::beside(folder).position_at(2)->isOnes());
  EXPECT_FALSE(Truth::beside(folder / "none").known());
  EXPECT_FALSE(Truth::beside("").known());
}

}  // namespace
}  // namespace stillpoint::output_web
