#include "bag/messages.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::bag {
namespace {

/// Of tf: a slash before it is left out.
std::string read_frame(ByteReader& reader) {
  std::string frame = reader.text();
  if (frame.starts_with('/')) frame.erase(0, 1);
  return frame;
}

MessageHeader read_header(ByteReader& reader, Serialisation serialisation) {
  if (serialisation == Serialisation::kRos1) reader.skip(4);  // seq, which ROS 2 has not
  MessageHeader header;
  const std::int64_t whole = reader.number<std::uint32_t>();
  header.stamp = whole * 1'000'000'000 + reader.number<std::uint32_t>();
  header.frame = read_frame(reader);
  return header;
}

ImageDescription read_description(ByteReader& reader, Serialisation serialisation,
                                  bool compressed) {
  ImageDescription image{.header = read_header(reader, serialisation), .compressed = compressed};
  if (!compressed) {
    image.height = static_cast<int>(reader.number<std::uint32_t>());
    image.width = static_cast<int>(reader.number<std::uint32_t>());
  }
  image.encoding = reader.text();
  return image;
}

template <std::size_t kCount>
void read_numbers(ByteReader& reader, std::array<double, kCount>& numbers) {
  for (double& number : numbers) number = reader.number<double>();
}

/// geometry_msgs/Transform.
std::optional<Pose> read_pose(ByteReader& reader) {
  constexpr double kUnit = 0.01;  // that the norm of a quaternion may be off
  std::array<double, 3> translation;
  std::array<double, 4> rotation;  // x, y, z, w
  read_numbers(reader, translation);
  read_numbers(reader, rotation);
  const Eigen::Quaterniond quaternion(rotation.data());
  const Eigen::Vector3d position(translation.data());
  if (!position.allFinite() || !(std::abs(quaternion.norm() - 1) < kUnit)) return std::nullopt;
  Pose pose = Pose::Identity();
  pose.linear() = quaternion.normalized().toRotationMatrix();
  pose.translation() = position;
  return pose;
}

}  // namespace

ImageKind ImageDescription::kind() const {
  const auto begins_with_one_of = [&](std::initializer_list<const char*> names) {
    return std::ranges::any_of(names, [&](const char* name) { return encoding.starts_with(name); });
  };
  if (begins_with_one_of({"16UC1", "32FC1", "mono16"}) ||
      encoding.find("compressedDepth") != std::string::npos)
    return ImageKind::kDepth;
  if (begins_with_one_of({"mono8", "8UC1"})) return ImageKind::kGray;
  if (begins_with_one_of({"rgb8", "bgr8", "rgba8", "bgra8", "8UC3", "yuv422", "uyvy", "yuyv",
                          "bayer_rggb8", "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8"}))
    return ImageKind::kColor;
  const bool file = encoding.find("jp") != std::string::npos || encoding.find("png") == 0;
  return compressed && file ? ImageKind::kColor : ImageKind::kOther;
}

MessageHeader header_of(ByteSpan message, Serialisation serialisation) {
  ByteReader reader(message, serialisation);
  return read_header(reader, serialisation);
}

ImageDescription describe_image(ByteSpan message, Serialisation serialisation, bool compressed) {
  ByteReader reader(message, serialisation);
  return read_description(reader, serialisation, compressed);
}

ImageMessage read_image(ByteSpan message, Serialisation serialisation, bool compressed) {
  ByteReader reader(message, serialisation);
  ImageMessage image{.description = read_description(reader, serialisation, compressed)};
  if (!compressed) {
    image.big_endian = reader.number<std::uint8_t>() != 0;
    image.step = reader.number<std::uint32_t>();
  }
  image.data = reader.byte_sequence();
  return image;
}

CameraInfoMessage read_camera_info(ByteSpan message, Serialisation serialisation) {
  ByteReader reader(message, serialisation);
  CameraInfoMessage info{.header = read_header(reader, serialisation)};
  info.height = static_cast<int>(reader.number<std::uint32_t>());
  info.width = static_cast<int>(reader.number<std::uint32_t>());
  info.model = reader.text();
  const auto count = reader.number<std::uint32_t>();
  if (count > reader.left() / sizeof(double)) throw Error(Fault::kData, "the bytes end too early");
  info.distortion.resize(count);
  for (double& coefficient : info.distortion) coefficient = reader.number<double>();
  read_numbers(reader, info.intrinsics);
  std::array<double, 9> rectification;
  read_numbers(reader, rectification);
  read_numbers(reader, info.projection);
  return info;
}

std::vector<TransformMessage> read_transforms(ByteSpan message, Serialisation serialisation) {
  ByteReader reader(message, serialisation);
  std::vector<TransformMessage> transforms;
  for (auto left = reader.number<std::uint32_t>(); left > 0; --left) {
    MessageHeader header = read_header(reader, serialisation);
    TransformMessage transform{
        .parent = std::move(header.frame), .child = read_frame(reader), .stamp = header.stamp};
    const auto pose = read_pose(reader);
    if (!pose) continue;
    transform.parent_from_child = *pose;
    transforms.push_back(std::move(transform));
  }
  return transforms;
}

std::optional<Pose> read_transform(ByteSpan message, Serialisation serialisation) {
  ByteReader reader(message, serialisation);
  return read_pose(reader);
}

float read_float(ByteSpan message, Serialisation serialisation) {
  ByteReader reader(message, serialisation);
  return reader.number<float>();
}

}  // namespace stillpoint::bag
