// The simulated recording as the camera of a robot, and what is true of it.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "evaluation/trajectory.hpp"
#include "ros2/fast_messages.hpp"
#include "support/image_io.hpp"
#include "support/simulated_recording.hpp"

namespace stillpoint::testing {

struct Images {
  FastHeader header;
  cv::Mat color, depth;  // CV_8UC3 in BGR order; CV_16UC1, 5000 per metre
};

/// The first `count` images of the simulated recording.
inline std::vector<Images> recorded_images(std::size_t count) {
  const std::filesystem::path& recording = simulated_recording();
  std::ifstream colors(recording / "rgb.txt"), depths(recording / "depth.txt");
  std::vector<Images> images;
  std::string color_line, depth_line;
  while (images.size() < count && std::getline(colors, color_line) &&
         std::getline(depths, depth_line)) {
    if (color_line.starts_with('#')) continue;
    std::istringstream color(color_line), depth(depth_line);
    std::string stamp, color_file, depth_file;
    color >> stamp >> color_file;
    depth >> depth_file >> depth_file;
    const std::size_t point = stamp.find('.');
    std::string fraction = stamp.substr(point + 1);
    fraction.resize(9, '0');
    images.push_back({{std::stoi(stamp.substr(0, point)),
                       static_cast<std::uint32_t>(std::stoul(fraction)), "camera_optical"},
                      read_image((recording / color_file), cv::IMREAD_COLOR),
                      read_image((recording / depth_file), cv::IMREAD_UNCHANGED)});
  }
  return images;
}

/// z forward, y down → x forward, z up.
inline Pose optical() {
  Pose pose = Pose::Identity();
  pose.linear() << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return pose;
}

/// 1.2 m above the base, looking forward.
inline Pose base_from_camera() {
  Pose pose = optical();
  pose.translation() = Eigen::Vector3d(0.1, 0, 1.2);
  return pose;
}

/// Of a camera on a base, in a map that is where the base was.
class Truth {
 public:
  Truth(double first, const Pose& camera_in_base)
      : poses_(evaluation::read_trajectory(simulated_recording() / "groundtruth.txt")),
        camera_in_base_(camera_in_base),
        map_from_room(camera_in_base * room_from_camera(first).inverse()) {}
  Pose room_from_camera(double time) const { return evaluation::pose_at(poses_, time); }
  double error_of(const FastPose& pose) const {  // metres
    const Pose truth = map_from_room * room_from_camera(pose.header.seconds());
    return (truth.translation() - (pose.header_from_child * camera_in_base_).translation()).norm();
  }

 private:
  evaluation::Trajectory poses_;
  Pose camera_in_base_;

 public:
  const Pose map_from_room;
};

/// The first one of `count` may be missing: its writer may not have found the reader yet.
inline void check_poses(const Truth& truth, const std::vector<FastPose>& poses, std::size_t count) {
  EXPECT_GE(poses.size(), count - 1);
  EXPECT_LE(poses.size(), count);
  double worst = 0;  // metres
  for (const FastPose& pose : poses) {
    worst = std::max(worst, truth.error_of(pose));
    EXPECT_EQ(pose.header.frame, "map");
  }
  EXPECT_LT(worst, 0.03);  // not aligned
  ::testing::Test::RecordProperty("worst_mm", std::to_string(worst * 1000));
}

/// The room's floor is z = 0.
inline void check_grid(const Truth& truth, const FastGrid& grid) {
  EXPECT_EQ(grid.header.frame, "map");
  EXPECT_FLOAT_EQ(grid.resolution, 0.05F);
  EXPECT_EQ(grid.cells.size(), grid.width * grid.height);
  EXPECT_GT(std::ranges::count(grid.cells, std::int8_t{0}), 200);
  EXPECT_GT(std::ranges::count(grid.cells, std::int8_t{100}), 50);
  const Pose room_from_grid = truth.map_from_room.inverse() * grid.header_from_origin;
  EXPECT_GT(room_from_grid(2, 2), 0.999);
  EXPECT_LT(std::abs(room_from_grid(2, 3)), 0.06);  // metres
}

}  // namespace stillpoint::testing
