#include "orb_slam/bundle_solver.hpp"

#include <ceres/ceres.h>
#include <ceres/rotation.h>
#include <gtest/gtest.h>

#include <random>

#include "orb_slam/pose_solver.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr int kCameras = 6, kFixedCameras = 2, kPoints = 80;

// Cameras side by side before a cloud of points; some measurements are far off, some have no depth.
class BundleSolverTest : public testing::Test {
 protected:
  BundleSolverTest() {
    for (int i = 0; i < kPoints; ++i)
      points_.emplace_back(uniform(-1.5, 1.5), uniform(-1, 1), uniform(2, 5));
    for (int i = 0; i < kCameras; ++i) {
      Pose pose = Pose::Identity();
      pose.translation() << -0.2 * i, 0.03 * i, 0.05 * i;
      pose.linear() = exp_so3({0.01 * i, -0.02 * i, 0.01});
      cameras_.push_back(pose);
    }
    for (const Eigen::Vector3d& point : points_) {
      std::vector<BundleMeasurement>& seen = measurements_.emplace_back();
      for (const Pose& camera : cameras_) seen.push_back(measure(camera * point));
    }
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  double normal(double sigma) { return std::normal_distribution<double>(0, sigma)(random_); }

  BundleMeasurement measure(const Eigen::Vector3d& p) {
    const double wrong = uniform(0, 1) < 0.05 ? 30 : 0;  // px
    const bool depth = uniform(0, 1) < 0.8;
    return {.fx = 500,
            .fy = 510,
            .cx = 320,
            .cy = 240,
            .u = 500 * p.x() / p.z() + 320 + normal(1) + wrong,
            .v = 510 * p.y() / p.z() + 240 + normal(1),
            .inverse_depth = depth ? 1 / p.z() + normal(0.01) : 0,
            .pixel_weight = uniform(0.5, 1),
            .depth_weight = depth ? 100.0 : 0};
  }

  // What the solvers begin with: centimetres away from the truth, but for the fixed cameras.
  void disturb() {
    for (int i = kFixedCameras; i < kCameras; ++i)
      cameras_[i] = exp_se3(Vector6d::NullaryExpr([&] { return normal(0.02); })) * cameras_[i];
    for (Eigen::Vector3d& point : points_)
      point += Eigen::Vector3d::NullaryExpr([&] { return normal(0.05); });
  }

  BundleSolver solver() const {
    BundleSolver solver;
    for (int i = 0; i < kCameras; ++i) solver.add_camera(cameras_[i], i >= kFixedCameras);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      solver.add_point(points_[i]);
      for (int camera = 0; camera < kCameras; ++camera)
        solver.observe(camera, measurements_[i][camera]);
    }
    return solver;
  }

  std::mt19937 random_{3};
  std::vector<Pose> cameras_;  // camera from world
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::vector<BundleMeasurement>> measurements_;  // by point and camera
};

struct Reprojection {
  template <typename T>
  bool operator()(const T* camera, const T* point, T* residual) const {
    T p[3];
    ceres::AngleAxisRotatePoint(camera + 3, point, p);
    for (int i = 0; i < 3; ++i) p[i] += camera[i];
    residual[0] = m.pixel_weight * (m.fx * p[0] / p[2] + m.cx - m.u);
    residual[1] = m.pixel_weight * (m.fy * p[1] / p[2] + m.cy - m.v);
    residual[2] = m.depth_weight * (1.0 / p[2] - m.inverse_depth);
    return true;
  }
  BundleMeasurement m;
};

TEST_F(BundleSolverTest, AgreesWithCeres) {
  disturb();
  BundleSolver ours = solver();
  ASSERT_TRUE(ours.solve(200, {}));

  std::vector<Vector6d> cameras;
  for (const Pose& camera : cameras_) {
    cameras.emplace_back();
    cameras.back() << camera.translation(), log_so3(camera.linear());
  }
  std::vector<Eigen::Vector3d> points = points_;
  ceres::Problem problem;
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int camera = 0; camera < kCameras; ++camera)
      problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Reprojection, 3, 6, 3>(
                                   new Reprojection{measurements_[i][camera]}),
                               new ceres::HuberLoss(std::sqrt(kChiSquare3)), cameras[camera].data(),
                               points[i].data());
  for (int i = 0; i < kFixedCameras; ++i) problem.SetParameterBlockConstant(cameras[i].data());
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 500;
  options.function_tolerance = options.parameter_tolerance = 1e-14;
  ceres::Solver::Summary summary;
  ceres::Solve(options, &problem, &summary);

  // Ours ends when the error falls by less than a millionth.
  for (int i = 0; i < kCameras; ++i) {
    const Pose found = ours.camera_from_world(i);
    EXPECT_LT((found.translation() - cameras[i].head<3>()).norm(), 2e-5) << "camera " << i;
    EXPECT_LT((log_so3(found.linear()) - cameras[i].tail<3>()).norm(), 1e-5) << "camera " << i;
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    EXPECT_LT((ours.point(i) - points[i]).norm(), 5e-3) << "point " << i;
}

TEST_F(BundleSolverTest, CamerasThatStayDoSoToTheBit) {
  disturb();
  BundleSolver ours = solver();
  ASSERT_TRUE(ours.solve(10, {}));
  for (int i = 0; i < kFixedCameras; ++i)
    EXPECT_EQ(ours.camera_from_world(i).matrix(), cameras_[i].matrix());
  for (int i = kFixedCameras; i < kCameras; ++i)
    EXPECT_NE(ours.camera_from_world(i).matrix(), cameras_[i].matrix());
}

TEST_F(BundleSolverTest, PointsAloneGoWhereTheirRaysMeet) {
  BundleSolver ours;
  ours.add_camera(cameras_[0], false);
  ours.add_camera(cameras_[5], false);
  ours.add_point(points_[0] + Eigen::Vector3d(0.1, -0.1, 0.2));
  for (const int camera : {0, 1}) {
    const Eigen::Vector3d p = cameras_[camera == 0 ? 0 : 5] * points_[0];
    ours.observe(camera, {500, 500, 320, 240, 500 * p.x() / p.z() + 320, 500 * p.y() / p.z() + 240,
                          0, 1, 0});
  }
  ASSERT_TRUE(ours.solve(50, {}));
  EXPECT_LT((ours.point(0) - points_[0]).norm(), 1e-4);
}

TEST_F(BundleSolverTest, APointBehindTheCameraTellsNothing) {
  BundleSolver ours;
  ours.add_camera(Pose::Identity(), true);
  const Eigen::Vector3d behind(0, 0, -1);
  ours.add_point(behind);
  ours.observe(0, {500, 500, 320, 240, 320, 240, 1, 1, 100});
  ASSERT_TRUE(ours.solve(10, {}));
  EXPECT_EQ(ours.point(0), behind);
  EXPECT_EQ(ours.camera_from_world(0).matrix(), Pose::Identity().matrix());
}

TEST_F(BundleSolverTest, WithoutObservationsThereIsNothingToSolve) {
  BundleSolver ours;
  ours.add_camera(Pose::Identity(), true);
  ours.add_point(points_[0]);
  EXPECT_FALSE(ours.solve(10, {}));
}

TEST_F(BundleSolverTest, StopsAtOnceWhenAskedTo) {
  disturb();
  std::stop_source end_early;
  end_early.request_stop();
  BundleSolver ours = solver();
  ASSERT_TRUE(ours.solve(10, end_early.get_token()));
  EXPECT_EQ(ours.point(0), points_[0]);
}

}  // namespace
}  // namespace stillpoint::orb_slam
