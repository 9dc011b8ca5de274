// Messages of ROS 2, and how they become bytes. Poses, points and frames as in REP 103 and 105:
// metres, radians, the map's z axis up; a camera's own frame is the optical one, x right, y down, z
// forward.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <string>
#include <utility>
#include <vector>

#include "ros2_messages/byte_writer.hpp"
#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::ros2_messages {

/// Nanoseconds since 1970. ROS 2 has 32 bits for the seconds: times outside become the nearest one
/// inside.
std::uint64_t nanoseconds(double seconds);

struct Header {
  double time = 0;    ///< seconds
  std::string frame;  ///< that the message is in
};

struct Text {
  static constexpr const char* kType = "std_msgs/String";
  std::string text;
};

struct Image {
  static constexpr const char* kType = "sensor_msgs/Image";
  Header header;
  cv::Mat pixels;  ///< CV_8UC3: "bgr8"; CV_32FC1: "32FC1", a depth image in metres (REP 118)
};

struct CompressedImage {
  static constexpr const char* kType = "sensor_msgs/CompressedImage";
  Header header;
  std::string format;  ///< "jpeg" or "png"
  Bytes file;
};

struct CameraInfo {
  static constexpr const char* kType = "sensor_msgs/CameraInfo";
  Header header;
  Camera camera;  ///< its images are rectified
};

struct PointCloud {
  static constexpr const char* kType = "sensor_msgs/PointCloud2";
  Header header;
  std::vector<Eigen::Vector3f> points;
  std::vector<std::uint32_t> rgb;     ///< 0x00RRGGBB per point; empty: no colours
  std::vector<std::uint8_t> classes;  ///< class id per point, field `label`; empty: no classes
};

struct Voxels {
  static constexpr const char* kType = "visualization_msgs/Marker";  ///< CUBE_LIST
  Header header;
  double edge = 0;  ///< metres; along the frame's axes
  std::vector<Eigen::Vector3f> centres;
  std::vector<std::uint32_t> rgb;  ///< 0x00RRGGBB per voxel
};

struct PoseMessage {
  static constexpr const char* kType = "geometry_msgs/PoseStamped";
  Header header;
  Pose pose = Pose::Identity();
};

struct Transform {
  static constexpr const char* kType = "tf2_msgs/TFMessage";
  Header header;
  std::string child;
  Pose header_from_child = Pose::Identity();
};

struct Odometry {
  static constexpr const char* kType = "nav_msgs/Odometry";
  Header header;
  std::string child;
  Pose header_from_child = Pose::Identity();
  Matrix6d covariance = Matrix6d::Zero();  ///< of the pose, x, y, z, then rotation, in the header's
                                           ///< frame; 0: not known
  Vector6d twist = Vector6d::Zero();       ///< m/s, then rad/s, in the child's frame
};

struct Path {
  static constexpr const char* kType = "nav_msgs/Path";
  Header header;
  std::vector<StampedPose> poses;  ///< in the header's frame
};

struct OccupancyGrid {
  static constexpr const char* kType = "nav_msgs/OccupancyGrid";
  static constexpr std::int8_t kFree = 0, kOccupied = 100, kUnknown = -1;
  Header header;
  double resolution = 0;  ///< metres
  Pose header_from_origin =
      Pose::Identity();  ///< of the lower left corner of the first cell; x along rows, z up
  cv::Mat cells;         ///< CV_8SC1; first row: smallest y
};

/// In OctoMap's binary format: occupied and free voxels.
struct Octree {
  static constexpr const char* kType = "octomap_msgs/Octomap";
  Header header;
  double resolution = 0;  ///< metres
  Bytes nodes;            ///< what follows the header of a .bt file
};

/// Health of one component.
struct Diagnosis {
  static constexpr const char* kType = "diagnostic_msgs/DiagnosticStatus";
  enum class Level : std::uint8_t { kOk = 0, kWarning = 1, kError = 2 } level = Level::kOk;
  std::string name;                                         ///< of the part
  std::string message;                                      ///< of a word or two
  std::vector<std::pair<std::string, std::string>> values;  ///< by keys
};

Bytes cdr_of(const Text& message);
Bytes cdr_of(const Image& message);
Bytes cdr_of(const CompressedImage& message);
Bytes cdr_of(const CameraInfo& message);
Bytes cdr_of(const PointCloud& message);
Bytes cdr_of(const Voxels& message);
Bytes cdr_of(const PoseMessage& message);
Bytes cdr_of(const Transform& message);
Bytes cdr_of(const Odometry& message);
Bytes cdr_of(const Path& message);
Bytes cdr_of(const OccupancyGrid& message);
Bytes cdr_of(const Octree& message);
Bytes cdr_of(const Diagnosis& message);

}  // namespace stillpoint::ros2_messages
