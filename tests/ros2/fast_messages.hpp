// Messages of ROS 2, written and read with the library of Fast DDS, by their public definitions.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "ros2/fast_dds.hpp"
#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::testing {

struct FastHeader {
  std::int32_t sec = 0;
  std::uint32_t nanosec = 0;
  std::string frame;

  double seconds() const { return sec + nanosec * 1e-9; }
};

Payload image_payload(const FastHeader& header, const cv::Mat& pixels, const std::string& encoding);
Payload camera_info_payload(const FastHeader& header, const Camera& camera);

struct FastPose {
  FastHeader header;
  std::string child;
  Pose header_from_child = Pose::Identity();
};

struct FastOdometry {
  FastPose pose;
  Matrix6d covariance;
  Vector6d twist;
};

struct FastState {
  int level = 0;
  std::string name, message;
  std::vector<std::pair<std::string, std::string>> values;
};

struct FastCloud {
  FastHeader header;
  std::uint32_t width = 0, point_step = 0;
  std::vector<std::string> fields;
  std::vector<std::uint8_t> data;
};

struct FastGrid {
  FastHeader header;
  float resolution = 0;
  std::uint32_t width = 0, height = 0;
  Pose header_from_origin = Pose::Identity();
  std::vector<std::int8_t> cells;
};

struct FastOctree {
  FastHeader header;
  bool binary = false;
  std::string id;
  double resolution = 0;
  std::vector<std::int8_t> data;
};

// They throw when the bytes end too early, or some are left.
std::vector<FastPose> read_transforms(const Payload& payload);
FastPose read_pose(const Payload& payload);
FastOdometry read_odometry(const Payload& payload);
std::vector<FastPose> read_path(const Payload& payload);
FastState read_state(const Payload& payload);
FastCloud read_cloud(const Payload& payload);
FastGrid read_grid(const Payload& payload);
FastOctree read_octree(const Payload& payload);

}  // namespace stillpoint::testing
