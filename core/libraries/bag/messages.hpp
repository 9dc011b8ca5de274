// The messages that hold images, cameras and how their frames lie, of ROS 1 and of ROS 2.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bag/byte_reader.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::bag {

inline constexpr std::string_view kImageType = "sensor_msgs/Image";
inline constexpr std::string_view kCompressedImageType = "sensor_msgs/CompressedImage";
inline constexpr std::string_view kCameraInfoType = "sensor_msgs/CameraInfo";
inline constexpr std::string_view kTransformTypes[] = {"tf2_msgs/TFMessage", "tf/tfMessage"};
inline constexpr std::string_view kOneTransformType = "geometry_msgs/Transform";
inline constexpr std::string_view kFloatType = "std_msgs/Float32";

/// std_msgs/Header.
struct MessageHeader {
  std::int64_t stamp = 0;  ///< ns since 1970; 0: the driver has set none
  std::string frame;       ///< of tf, without the slash before it that old ones have
};

enum class ImageKind { kColor, kGray, kDepth, kOther };

/// What stands before the pixels.
struct ImageDescription {
  MessageHeader header;
  bool compressed = false;
  int width = 0, height = 0;  ///< px; 0 when compressed
  std::string encoding;       ///< "rgb8", "16UC1", …; when compressed its format, "jpeg", …

  ImageKind kind() const;
  /// Depth as floating-point numbers; that of 16 bits has a unit of its own.
  bool in_metres() const { return encoding.starts_with("32FC1"); }
};

/// sensor_msgs/Image, or CompressedImage with `data` only. Its bytes are those of the message.
struct ImageMessage {
  ImageDescription description;
  bool big_endian = false;
  std::size_t step = 0;  ///< bytes of a row
  ByteSpan data;
};

struct CameraInfoMessage {
  MessageHeader header;
  int width = 0, height = 0;  ///< px
  std::string model;          ///< "plumb_bob", "rational_polynomial", …
  std::vector<double> distortion;
  std::array<double, 9> intrinsics = {};   ///< K, row by row, of the image as recorded
  std::array<double, 12> projection = {};  ///< P, row by row, of the rectified image
};

/// geometry_msgs/TransformStamped, as tf has it.
struct TransformMessage {
  std::string parent, child;  ///< frames
  Pose parent_from_child = Pose::Identity();
  std::int64_t stamp = 0;  ///< ns
};

/// All of these throw Error(kData) when the bytes end too early, which a description needs few of.
MessageHeader header_of(ByteSpan message, Serialisation serialisation);
ImageDescription describe_image(ByteSpan message, Serialisation serialisation, bool compressed);
ImageMessage read_image(ByteSpan message, Serialisation serialisation, bool compressed);
CameraInfoMessage read_camera_info(ByteSpan message, Serialisation serialisation);
/// Without those whose numbers are no rigid transform.
std::vector<TransformMessage> read_transforms(ByteSpan message, Serialisation serialisation);
/// geometry_msgs/Transform; nothing when its numbers are no rigid transform.
std::optional<Pose> read_transform(ByteSpan message, Serialisation serialisation);
/// std_msgs/Float32.
float read_float(ByteSpan message, Serialisation serialisation);

}  // namespace stillpoint::bag
