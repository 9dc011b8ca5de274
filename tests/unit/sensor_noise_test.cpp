// The model of a sensor's noise: one in Camera, and everybody has it.
#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/support/depth_step.hpp"
#include "stillpoint/support/pixel_scale.hpp"
#include "stillpoint/support/rectifier.hpp"
#include "stillpoint/testing/test_recording.hpp"

namespace stillpoint {
namespace {

TEST(SensorNoise, TheJacobianOfAMeasurementIsItsDerivative) {
  const Camera camera{.fx = 520, .fy = 510, .cx = 300, .cy = 250};
  const auto measured = [&](const Eigen::Vector3d& point) -> Eigen::Vector3d {
    const Eigen::Vector2d pixel = camera.project(point);
    return {pixel.x(), pixel.y(), 1 / point.z()};
  };
  constexpr double kStep = 1e-6;  // m
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0, 0, 1), Eigen::Vector3d(0.4, -0.3, 2), Eigen::Vector3d(-1, 0.7, 5)}) {
    Eigen::Matrix3d expected;
    for (int axis = 0; axis < 3; ++axis) {
      const Eigen::Vector3d step = kStep * Eigen::Vector3d::Unit(axis);
      expected.col(axis) = (measured(point + step) - measured(point - step)) / (2 * kStep);
    }
    EXPECT_TRUE(camera.measurement_jacobian(point).isApprox(expected, 1e-6));
    // A constant error of the inverse depth is one of the depth that grows with its square.
    EXPECT_NEAR(-camera.measurement_jacobian(point)(2, 2), 1 / (point.z() * point.z()), 1e-12);
  }
}

TEST(SensorNoise, GoesFromTheModelToEveryFrame) {
  CameraModel model{.width = 64, .height = 48, .depth_noise = 0.03, .surface_noise = 0.004};
  for (const auto& crop : {std::vector<double>{}, std::vector<double>{8, 8, 40, 32}}) {
    model.crop = crop;
    const Frame frame = Rectifier(model).frame(0, cv::Mat::zeros(48, 64, CV_8UC3),
                                               cv::Mat(48, 64, CV_16UC1, cv::Scalar(5000)));
    for (const Camera& camera : {model.undistorted(), *frame.camera}) {
      EXPECT_EQ(camera.depth_noise, 0.03);
      EXPECT_EQ(camera.surface_noise, 0.004);
    }
  }
}

TEST(SensorNoise, OfTheTestRecordingIsThatOfItsCamera) {
  constexpr double kNoise = 0.01;
  const testing::TestRecording ideal({.frames = 1}), noisy({.frames = 1, .depth_noise = kNoise});
  EXPECT_EQ(ideal.camera().surface_noise, Camera().surface_noise);
  EXPECT_EQ(noisy.camera().surface_noise, kNoise);
  EXPECT_GE(noisy.camera().depth_noise, kNoise);
  const cv::Mat truth = ideal.frame(0)->depth, measured = noisy.frame(0)->depth;
  const cv::Mat at_one_metre = (measured - truth) / truth.mul(truth);
  cv::Scalar mean, deviation;
  cv::meanStdDev(at_one_metre, mean, deviation);
  EXPECT_NEAR(mean[0], 0, 0.02 * kNoise);
  EXPECT_NEAR(deviation[0], kNoise, 0.02 * kNoise);
}

TEST(DepthStep, IsAShareOfTheDepthOrTheNoiseWhicheverIsMore) {
  constexpr DepthStep kStep{.share = 0.04F, .sigmas = 4};
  constexpr float kNoise = 0.002F;  // at 1 m; four standard deviations are 4 % of 5 m
  EXPECT_FLOAT_EQ(kStep.limit(2), 0.08F);
  EXPECT_FLOAT_EQ(kStep.limit(2, kNoise), 0.08F);
  EXPECT_FLOAT_EQ(kStep.limit(5, kNoise), 0.2F);
  EXPECT_FLOAT_EQ(kStep.limit(8, kNoise), 4 * kNoise * 64);
  EXPECT_TRUE(kStep.is_between(2, 2.1F, kNoise));
  EXPECT_TRUE(kStep.is_between(2, 1.9F, kNoise));
  EXPECT_FALSE(kStep.is_between(2, 2.07F, kNoise));
  EXPECT_FALSE(kStep.is_between(8, 8.5F, kNoise));
}

TEST(PixelScale, IsThatOfTheFocalLengthAtOneAngleOfView) {
  EXPECT_EQ(pixel_scale({640, 480}), 1);
  EXPECT_EQ(pixel_scale({480, 640}), 1);
  EXPECT_EQ(pixel_scale({320, 240}), 0.5);
  EXPECT_EQ(pixel_scale({1280, 960}), 2);
  EXPECT_NEAR(pixel_scale({848, 480}), 1.151, 0.001);
  EXPECT_NEAR(pixel_scale({1280, 720}), std::sqrt(3.0), 1e-12);
}

}  // namespace
}  // namespace stillpoint
