#include "ros2_messages/messages.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ros2_messages/cdr_writer.hpp"

namespace stillpoint::ros2_messages {
namespace {

constexpr std::uint64_t kSecond = 1'000'000'000;  // ns

std::uint32_t unsigned_of(int number) { return static_cast<std::uint32_t>(number); }

void put(CdrWriter& out, const Header& header) {
  const std::uint64_t time = nanoseconds(header.time);
  out.number(static_cast<std::int32_t>(time / kSecond));
  out.number(static_cast<std::uint32_t>(time % kSecond));
  out.text(header.frame);
}

void put(CdrWriter& out, const Eigen::Vector3d& v) {
  for (const double number : v) out.number(number);
}

/// Of Pose and of Transform, which have the same fields.
void put(CdrWriter& out, const Pose& pose) {
  put(out, Eigen::Vector3d(pose.translation()));
  const Eigen::Quaterniond rotation = Eigen::Quaterniond(pose.linear()).normalized();
  for (const double number : rotation.coeffs()) out.number(number);  // x, y, z, w
}

void put_rows(CdrWriter& out, const Eigen::Ref<const Eigen::MatrixXd>& matrix) {
  for (Eigen::Index row = 0; row < matrix.rows(); ++row)
    for (Eigen::Index column = 0; column < matrix.cols(); ++column) out.number(matrix(row, column));
}

void put_pixels(CdrWriter& out, const cv::Mat& image) {
  const std::size_t step = image.elemSize() * static_cast<std::size_t>(image.cols);
  out.count(step * static_cast<std::size_t>(image.rows));
  for (int y = 0; y < image.rows; ++y) out.raw({image.ptr(y), step});
}

/// std_msgs/ColorRGBA.
void put_color(CdrWriter& out, std::uint32_t rgb) {
  for (const int shift : {16, 8, 0}) out.number(static_cast<float>(rgb >> shift & 0xff) / 255);
  out.number(1.0F);
}

// sensor_msgs/PointField
constexpr std::uint8_t kUint8 = 2, kFloat32 = 7;

void put_field(CdrWriter& out, const char* name, std::uint32_t offset, std::uint8_t type) {
  out.text(name);
  out.number(offset);
  out.number(type);
  out.number(std::uint32_t{1});
}

}  // namespace

std::uint64_t nanoseconds(double seconds) {
  constexpr double kLast = std::numeric_limits<std::int32_t>::max();
  return static_cast<std::uint64_t>(std::llround(std::clamp(seconds, 0.0, kLast) * kSecond));
}

Bytes cdr_of(const Text& message) {
  CdrWriter out;
  out.text(message.text);
  return std::move(out).take();
}

Bytes cdr_of(const Image& message) {
  const cv::Mat& pixels = message.pixels;
  CdrWriter out;
  put(out, message.header);
  out.number(unsigned_of(pixels.rows));
  out.number(unsigned_of(pixels.cols));
  out.text(pixels.type() == CV_8UC3 ? "bgr8" : "32FC1");
  out.number(std::uint8_t{0});  // little-endian
  out.number(static_cast<std::uint32_t>(pixels.elemSize()) * unsigned_of(pixels.cols));
  put_pixels(out, pixels);
  return std::move(out).take();
}

Bytes cdr_of(const CompressedImage& message) {
  CdrWriter out;
  put(out, message.header);
  out.text(message.format);
  out.count(message.file.size());
  out.raw(message.file);
  return std::move(out).take();
}

Bytes cdr_of(const CameraInfo& message) {
  const Camera& camera = message.camera;
  Eigen::Matrix<double, 3, 4> projection;
  projection << camera.fx, 0, camera.cx, 0,  //
      0, camera.fy, camera.cy, 0,            //
      0, 0, 1, 0;
  CdrWriter out;
  put(out, message.header);
  out.number(unsigned_of(camera.height));
  out.number(unsigned_of(camera.width));
  out.text("plumb_bob");
  out.count(5);
  for (int i = 0; i < 5; ++i) out.number(0.0);  // no distortion
  put_rows(out, projection.leftCols<3>());
  put_rows(out, Eigen::Matrix3d::Identity());
  put_rows(out, projection);
  for (int i = 0; i < 6; ++i) out.number(std::uint32_t{0});  // no binning, no region of interest
  out.number(std::uint8_t{0});
  return std::move(out).take();
}

Bytes cdr_of(const PointCloud& message) {
  const bool colors = !message.rgb.empty(), classes = !message.classes.empty();
  const std::uint32_t label_at = colors ? 16 : 12, step = label_at + (classes ? 1 : 0);
  const std::size_t points = message.points.size();
  CdrWriter out;
  put(out, message.header);
  out.number(std::uint32_t{1});
  out.number(static_cast<std::uint32_t>(points));
  out.count(3 + (colors ? 1 : 0) + (classes ? 1 : 0));
  put_field(out, "x", 0, kFloat32);
  put_field(out, "y", 4, kFloat32);
  put_field(out, "z", 8, kFloat32);
  if (colors) put_field(out, "rgb", 12, kFloat32);  // its bits are those of the colour
  if (classes) put_field(out, "label", label_at, kUint8);
  out.number(std::uint8_t{0});  // little-endian
  out.number(step);
  out.number(static_cast<std::uint32_t>(points * step));
  Bytes data;
  data.reserve(points * step);
  for (std::size_t i = 0; i < points; ++i) {
    for (const float coordinate : message.points[i]) append(data, coordinate);
    if (colors) append(data, message.rgb[i]);
    if (classes) append(data, message.classes[i]);
  }
  out.count(data.size());
  out.raw(data);
  out.number(std::uint8_t{1});  // no points without coordinates
  return std::move(out).take();
}

Bytes cdr_of(const Voxels& message) {
  constexpr std::int32_t kCubeList = 6, kAdd = 0;
  CdrWriter out;
  put(out, message.header);
  out.text("voxels");           // ns
  out.number(std::int32_t{0});  // id
  out.number(kCubeList);
  out.number(kAdd);
  put(out, Pose(Pose::Identity()));
  put(out, Eigen::Vector3d(Eigen::Vector3d::Constant(message.edge)));
  put_color(out, 0xffffff);
  for (int i = 0; i < 2; ++i) out.number(std::int32_t{0});  // lifetime: for ever
  out.number(std::uint8_t{0});                              // frame_locked
  out.count(message.centres.size());
  for (const Eigen::Vector3f& centre : message.centres)
    put(out, Eigen::Vector3d(centre.cast<double>()));
  out.count(message.rgb.size());
  for (const std::uint32_t rgb : message.rgb) put_color(out, rgb);
  out.text("");                              // texture_resource
  put(out, Header{});                        // of the texture
  out.text("");                              // its format
  for (int i = 0; i < 2; ++i) out.count(0);  // its data, uv_coordinates
  for (int i = 0; i < 3; ++i) out.text("");  // text, mesh_resource, name of the mesh_file
  out.count(0);                              // its data
  out.number(std::uint8_t{0});               // mesh_use_embedded_materials
  return std::move(out).take();
}

Bytes cdr_of(const PoseMessage& message) {
  CdrWriter out;
  put(out, message.header);
  put(out, message.pose);
  return std::move(out).take();
}

Bytes cdr_of(const Transform& message) {
  CdrWriter out;
  out.count(1);
  put(out, message.header);
  out.text(message.child);
  put(out, message.header_from_child);
  return std::move(out).take();
}

Bytes cdr_of(const Odometry& message) {
  CdrWriter out;
  put(out, message.header);
  out.text(message.child);
  put(out, message.header_from_child);
  put_rows(out, message.covariance);
  put(out, Eigen::Vector3d(message.twist.head<3>()));
  put(out, Eigen::Vector3d(message.twist.tail<3>()));
  put_rows(out, Matrix6d::Zero());  // of the twist: not known
  return std::move(out).take();
}

Bytes cdr_of(const Path& message) {
  CdrWriter out;
  put(out, message.header);
  out.count(message.poses.size());
  for (const StampedPose& pose : message.poses) {
    put(out, Header{pose.time, message.header.frame});
    put(out, pose.world_from_camera);
  }
  return std::move(out).take();
}

Bytes cdr_of(const OccupancyGrid& message) {
  CdrWriter out;
  put(out, message.header);
  for (int i = 0; i < 2; ++i) out.number(std::uint32_t{0});  // map_load_time
  out.number(static_cast<float>(message.resolution));
  out.number(unsigned_of(message.cells.cols));
  out.number(unsigned_of(message.cells.rows));
  put(out, message.header_from_origin);
  put_pixels(out, message.cells);
  return std::move(out).take();
}

Bytes cdr_of(const Octree& message) {
  CdrWriter out;
  put(out, message.header);
  out.number(std::uint8_t{1});  // binary
  out.text("OcTree");           // as which viewers take it, whatever else the tree could hold
  out.number(message.resolution);
  out.count(message.nodes.size());
  out.raw(message.nodes);
  return std::move(out).take();
}

Bytes cdr_of(const Diagnosis& message) {
  CdrWriter out;
  out.number(static_cast<std::uint8_t>(message.level));
  out.text(message.name);
  out.text(message.message);
  out.text("");  // hardware_id
  out.count(message.values.size());
  for (const auto& [key, value] : message.values) {
    out.text(key);
    out.text(value);
  }
  return std::move(out).take();
}

}  // namespace stillpoint::ros2_messages
