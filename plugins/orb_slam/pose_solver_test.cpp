#include "orb_slam/pose_solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "orb_slam/test_world.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr double kPixelSigma = 1.0, kDepthSigma = 0.01;

class PoseSolverTest : public testing::Test {
 protected:
  // Measurements of random points from `truth_`, with `noise` standard deviations of noise.
  std::vector<PoseObservation> observe(int count, double noise, bool with_depth) {
    std::vector<PoseObservation> observations;
    while (static_cast<int>(observations.size()) < count) {
      const double z = random_.uniform(1, 6);
      const double u = random_.uniform(0, 639), v = random_.uniform(0, 479);
      PoseObservation o{.point_in_world = truth_.inverse() * camera_.unproject(u, v, z),
                        .pixel = Eigen::Vector2d(u, v),
                        .pixel_sigma = kPixelSigma,
                        .inverse_depth_sigma = kDepthSigma};
      o.pixel += noise * kPixelSigma * Eigen::Vector2d(random_.normal(), random_.normal());
      if (with_depth) o.inverse_depth = 1.0 / z + noise * kDepthSigma * random_.normal();
      observations.push_back(o);
    }
    return observations;
  }
  void spoil(std::vector<PoseObservation>& observations, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i)
      observations[i].pixel = {random_.uniform(0, 639), random_.uniform(0, 479)};
  }
  void expect_near(const PoseSolution& solution, double metres, double radians) const {
    EXPECT_LT(metres_between(solution.camera_from_world, truth_), metres);
    EXPECT_LT(radians_between(solution.camera_from_world, truth_), radians);
  }

  TestWorld random_{0};
  Camera camera_;
  Pose truth_ = pose_at({0.5, -0.2, 0.3}, {0.2, -0.4, 0.1});
  Pose guess_ = pose_at({0.08, -0.06, 0.05}, {0.04, 0.03, -0.05}) * truth_;
};

TEST_F(PoseSolverTest, ExactMeasurementsGiveTheExactPose) {
  for (const bool with_depth : {false, true}) {
    const PoseSolution solution = solve_pose(observe(100, 0, with_depth), camera_, guess_);
    expect_near(solution, 1e-7, 1e-7);
    EXPECT_EQ(solution.inliers, 100);
  }
}

TEST_F(PoseSolverTest, NoiseIsAveraged) {
  expect_near(solve_pose(observe(500, 1, true), camera_, guess_), 0.002, 0.001);
  expect_near(solve_pose(observe(500, 1, false), camera_, guess_), 0.003, 0.001);
}

TEST_F(PoseSolverTest, MostGoodMeasurementsStayInliers) {
  const PoseSolution solution = solve_pose(observe(1000, 1, true), camera_, guess_);
  EXPECT_GT(solution.inliers, 920);  // 95 % expected
  EXPECT_EQ(solution.inliers, std::count(solution.inlier.begin(), solution.inlier.end(), true));
}

TEST_F(PoseSolverTest, ThirtyPercentOutliersDoNotMatter) {
  for (const bool with_depth : {false, true}) {
    auto observations = observe(300, 1, with_depth);
    spoil(observations, 90);
    const PoseSolution solution = solve_pose(observations, camera_, guess_);
    expect_near(solution, 0.005, 0.002);
    EXPECT_LT(std::count(solution.inlier.begin(), solution.inlier.begin() + 90, true), 5);
    EXPECT_GT(std::count(solution.inlier.begin() + 90, solution.inlier.end(), true), 180);
  }
}

TEST_F(PoseSolverTest, WrongDepthAloneMakesAnOutlier) {
  auto observations = observe(200, 1, true);
  for (int i = 0; i < 40; ++i) observations[i].inverse_depth += 0.3;
  const PoseSolution solution = solve_pose(observations, camera_, guess_);
  expect_near(solution, 0.005, 0.002);
  EXPECT_EQ(std::count(solution.inlier.begin(), solution.inlier.begin() + 40, true), 0);
}

TEST_F(PoseSolverTest, PointsOfNoWeightDoNotPull) {
  // Half of the points move together, like a person: a consistent second motion.
  auto observations = observe(200, 0.5, true);
  for (int i = 0; i < 100; ++i) {
    observations[i].point_in_world += Eigen::Vector3d(0.02, 0.0, 0.01);
    observations[i].weight = 0.0;
  }
  expect_near(solve_pose(observations, camera_, guess_), 0.002, 0.001);
  for (int i = 0; i < 100; ++i) observations[i].weight = 1.0;
  const double pulled =
      metres_between(solve_pose(observations, camera_, guess_).camera_from_world, truth_);
  EXPECT_GT(pulled, 0.004);
  for (int i = 0; i < 100; ++i) observations[i].weight = 0.1;
  const double pulled_softly =
      metres_between(solve_pose(observations, camera_, guess_).camera_from_world, truth_);
  EXPECT_LT(pulled_softly, 0.5 * pulled);
}

TEST_F(PoseSolverTest, NothingButWorthlessPointsLeavesTheGuess) {
  auto observations = observe(50, 1, true);
  for (PoseObservation& o : observations) o.weight = 0.0;
  const PoseSolution solution = solve_pose(observations, camera_, guess_);
  EXPECT_TRUE(solution.camera_from_world.isApprox(guess_));
}

TEST_F(PoseSolverTest, TooFewPointsLeaveTheGuess) {
  for (const int count : {0, 1, 3}) {
    const PoseSolution solution = solve_pose(observe(count, 0, true), camera_, guess_);
    EXPECT_TRUE(solution.camera_from_world.isApprox(guess_));
    EXPECT_EQ(solution.inlier.size(), static_cast<std::size_t>(count));
  }
}

TEST_F(PoseSolverTest, PointsInOnePlaceGiveAFinitePose) {
  auto observations = observe(1, 0, false);
  observations.resize(50, observations.front());
  EXPECT_TRUE(solve_pose(observations, camera_, guess_).camera_from_world.matrix().allFinite());
}

TEST_F(PoseSolverTest, PointsBehindTheCameraAreOutliers) {
  auto observations = observe(100, 0, true);
  for (int i = 0; i < 20; ++i)  // the same pixel, seen from behind
    observations[i].point_in_world = truth_.inverse() * -(truth_ * observations[i].point_in_world);
  const PoseSolution solution = solve_pose(observations, camera_, guess_);
  expect_near(solution, 1e-6, 1e-6);
  EXPECT_EQ(std::count(solution.inlier.begin(), solution.inlier.begin() + 20, true), 0);
  EXPECT_EQ(solution.inliers, 80);
}

TEST_F(PoseSolverTest, AllPointsBehindTheCameraIsNoCrash) {
  auto observations = observe(100, 0, true);
  const PoseSolution solution =
      solve_pose(observations, camera_, pose_at({0, 0, 0}, {0, M_PI, 0}) * truth_);
  EXPECT_EQ(solution.inliers, 0);
  EXPECT_TRUE(solution.camera_from_world.matrix().allFinite());
}

TEST_F(PoseSolverTest, ConvergesFromFarAway) {
  const Pose far = pose_at({0.2, 0.15, -0.2}, {0.15, -0.15, 0.2}) * truth_;
  expect_near(solve_pose(observe(200, 0, true), camera_, far), 1e-6, 1e-6);
}

TEST_F(PoseSolverTest, ATermAloneHoldsThePose) {
  const QuadraticCost here{.linearised_at = truth_, .hessian = 100 * Matrix6d::Identity()};
  const PoseSolution solution =
      solve_pose({}, camera_, guess_, [&](const Pose& pose, int) { return here.moved_to(pose); });
  expect_near(solution, 1e-5, 1e-5);
  EXPECT_TRUE(solution.information.isApprox(here.hessian));
}

TEST_F(PoseSolverTest, ATermAndFewPointsShareTheDirections) {
  // The term knows everything but x; three points know that.
  QuadraticCost here{.linearised_at = truth_, .hessian = 1e6 * Matrix6d::Identity()};
  here.hessian(0, 0) = 0;
  const PoseSolution solution =
      solve_pose(observe(3, 0, true), camera_, guess_,
                 [&](const Pose& pose, int) { return here.moved_to(pose); });
  expect_near(solution, 1e-4, 1e-4);
  EXPECT_GT(solution.information(0, 0), 1e3);
  EXPECT_TRUE(solution.temporary_information.isZero());
}

TEST_F(PoseSolverTest, InformationIsThatOfTheErrors) {
  // Squared errors in units of what is claimed: six on average.
  double sum = 0;
  constexpr int kRuns = 40;
  for (int i = 0; i < kRuns; ++i) {
    const PoseSolution solution = solve_pose(observe(60, 1, true), camera_, guess_);
    const Vector6d error = log_se3(solution.camera_from_world * truth_.inverse());
    sum += error.dot(solution.information * error);
  }
  EXPECT_NEAR(sum / kRuns, 6.0, 2.0);
}

TEST_F(PoseSolverTest, TheShareOfTemporaryPointsIsKnown) {
  auto observations = observe(100, 0, true);
  for (PoseObservation& o : observations) o.temporary = true;
  const PoseSolution solution = solve_pose(observations, camera_, guess_);
  EXPECT_TRUE(solution.temporary_information.isApprox(solution.information));
}

TEST_F(PoseSolverTest, SameInputSameBits) {
  const auto observations = observe(300, 1, true);
  const PoseSolution a = solve_pose(observations, camera_, guess_);
  const PoseSolution b = solve_pose(observations, camera_, guess_);
  EXPECT_EQ(a.camera_from_world.matrix(), b.camera_from_world.matrix());
  EXPECT_EQ(a.inlier, b.inlier);
}

}  // namespace
}  // namespace stillpoint::orb_slam
