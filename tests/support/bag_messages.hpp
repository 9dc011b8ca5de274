// Messages of ROS 1 and ROS 2, by their definitions.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "bag/messages.hpp"
#include "support/bag_bytes.hpp"

namespace stillpoint::testing {

/// std_msgs/Header; `stamp` in ns.
inline void put_header(ByteWriter& writer, Serialisation serialisation, std::int64_t stamp,
                       const std::string& frame) {
  if (serialisation == Serialisation::kRos1) writer.number<std::uint32_t>(7);  // seq
  writer.number(static_cast<std::uint32_t>(stamp / 1'000'000'000));
  writer.number(static_cast<std::uint32_t>(stamp % 1'000'000'000));
  writer.text(frame);
}

inline ByteWriter message_with_header(Serialisation serialisation, std::int64_t stamp,
                                      const std::string& frame) {
  ByteWriter writer(serialisation);
  put_header(writer, serialisation, stamp, frame);
  return writer;
}

/// sensor_msgs/Image; `stamp` in ns.
inline BagBytes image_message(Serialisation serialisation, std::int64_t stamp,
                              const std::string& frame, const cv::Mat& image,
                              const std::string& encoding) {
  ByteWriter writer = message_with_header(serialisation, stamp, frame);
  writer.number(static_cast<std::uint32_t>(image.rows));
  writer.number(static_cast<std::uint32_t>(image.cols));
  writer.text(encoding).number<std::uint8_t>(0);
  writer.number(static_cast<std::uint32_t>(image.cols * image.elemSize()));
  return writer.sequence({image.data, image.data + image.total() * image.elemSize()}).bytes();
}

/// sensor_msgs/CompressedImage.
inline BagBytes compressed_message(Serialisation serialisation, std::int64_t stamp,
                                   const std::string& frame, const std::string& format,
                                   const BagBytes& file) {
  return message_with_header(serialisation, stamp, frame).text(format).sequence(file).bytes();
}

struct TestCameraInfo {
  std::string frame = "color_frame";
  int width = 64, height = 48;
  std::string model = "plumb_bob";
  std::vector<double> distortion = {0, 0, 0, 0, 0};
  double fx = 50, fy = 51, cx = 32, cy = 24;
  double rectified_fx = 45;  ///< of P
};

/// sensor_msgs/CameraInfo.
inline BagBytes camera_info_message(Serialisation serialisation, const TestCameraInfo& info = {}) {
  ByteWriter writer = message_with_header(serialisation, 1'000'000'000, info.frame);
  writer.number(static_cast<std::uint32_t>(info.height));
  writer.number(static_cast<std::uint32_t>(info.width));
  writer.text(info.model).number(static_cast<std::uint32_t>(info.distortion.size()));
  for (const double d : info.distortion) writer.number(d);
  for (const double k : {info.fx, 0., info.cx, 0., info.fy, info.cy, 0., 0., 1.}) writer.number(k);
  for (const double r : {1., 0., 0., 0., 1., 0., 0., 0., 1.}) writer.number(r);
  for (const double p :
       {info.rectified_fx, 0., info.cx, 0., 0., info.fy, info.cy, 0., 0., 0., 1., 0.})
    writer.number(p);
  return writer.bytes();
}

/// tf2_msgs/TFMessage.
inline BagBytes transforms_message(Serialisation serialisation,
                                   const std::vector<bag::TransformMessage>& transforms) {
  ByteWriter writer(serialisation);
  writer.number(static_cast<std::uint32_t>(transforms.size()));
  for (const bag::TransformMessage& transform : transforms) {
    put_header(writer, serialisation, transform.stamp, transform.parent);
    writer.text(transform.child);
    for (const double t : transform.parent_from_child.translation()) writer.number(t);
    const Eigen::Quaterniond rotation(transform.parent_from_child.linear());
    for (const double q : rotation.coeffs()) writer.number(q);  // x, y, z, w
  }
  return writer.bytes();
}

}  // namespace stillpoint::testing
