#include "camera.hpp"

#include <gtest/gtest.h>

namespace stillpoint_ros {
namespace {

sensor_msgs::CameraInfo distorted() {
  sensor_msgs::CameraInfo info;
  info.width = 640;
  info.height = 480;
  info.distortion_model = "plumb_bob";
  info.D = {0.1, -0.2, 0.001, 0, 0};
  info.K = {525, 0, 319, 0, 526, 239, 0, 0, 1};
  info.P = {500, 0, 310, 0, 0, 501, 230, 0, 0, 0, 1, 0};
  return info;
}

TEST(CameraOf, HasKAndTheDistortionOrPOfRectifiedImages) {
  const SensorCamera raw = camera_of(distorted(), {});
  EXPECT_EQ(raw.width, 640);
  EXPECT_EQ(raw.fy, 526);
  EXPECT_EQ(raw.cx, 319);
  EXPECT_EQ(raw.distortion, (std::vector<double>{0.1, -0.2, 0.001, 0}));
  Parameters parameters;
  parameters.rectified = true;
  parameters.depth_noise = 0.05;
  parameters.surface_noise = 0.004;
  const SensorCamera rectified = camera_of(distorted(), parameters);
  EXPECT_EQ(rectified.fx, 500);
  EXPECT_EQ(rectified.cy, 230);
  EXPECT_TRUE(rectified.distortion.empty());
  EXPECT_EQ(rectified.depth_noise, 0.05);
  EXPECT_EQ(rectified.surface_noise, 0.004);
}

TEST(CameraOf, AnotherDistortionOrNoCalibrationIsRefused) {
  sensor_msgs::CameraInfo info = distorted();
  info.distortion_model = "equidistant";
  EXPECT_THROW(camera_of(info, {}), stillpoint::Error);
  info.D = {0, 0, 0, 0};
  EXPECT_NO_THROW(camera_of(info, {}));
  info.distortion_model = "rational_polynomial";
  info.D = {0.1, 0.2, 0, 0, 0, 0.5, 0, 0};
  EXPECT_THROW(camera_of(info, {}), stillpoint::Error);
  EXPECT_THROW(camera_of(sensor_msgs::CameraInfo(), {}), stillpoint::Error);
}

}  // namespace
}  // namespace stillpoint_ros
