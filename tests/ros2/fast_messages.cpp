#include "ros2/fast_messages.hpp"

#include <fastcdr/Cdr.h>

#include <array>
#include <stdexcept>

namespace stillpoint::testing {
namespace {

using eprosima::fastcdr::Cdr;
using eprosima::fastcdr::FastBuffer;

class Writing {
 public:
  Writing() { cdr.serialize_encapsulation(); }
  Payload payload() {
    const char* bytes = buffer_.getBuffer();
    return {bytes, bytes + cdr.getSerializedDataLength()};
  }

 private:
  FastBuffer buffer_;

 public:
  Cdr cdr{buffer_, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
};

class Reading {
 public:
  explicit Reading(const Payload& payload)
      : payload_(payload), buffer_(payload_.data(), payload_.size()) {
    cdr.read_encapsulation();
  }
  template <class Value>
  Value get() {
    Value value;
    cdr >> value;
    return value;
  }
  /// Up to three bytes that fill a unit of four may be left.
  void end() {
    const std::size_t used = cdr.getSerializedDataLength();
    if (used > payload_.size() || payload_.size() - used > 3)
      throw std::runtime_error(std::to_string(used) + " of " + std::to_string(payload_.size()) +
                               " bytes of a message are used");
  }

 private:
  Payload payload_;
  FastBuffer buffer_;

 public:
  Cdr cdr{buffer_, Cdr::LITTLE_ENDIANNESS, Cdr::DDS_CDR};
};

void put(Cdr& cdr, const FastHeader& header) {
  cdr << header.sec << header.nanosec << header.frame;
}

FastHeader header_of(Reading& in) {
  FastHeader header;
  in.cdr >> header.sec >> header.nanosec >> header.frame;
  return header;
}

/// Of Pose, and of Transform.
Pose pose_of(Reading& in) {
  const auto numbers = in.get<std::array<double, 7>>();
  Pose pose(Eigen::Quaterniond(numbers[6], numbers[3], numbers[4], numbers[5]));
  pose.translation() = Eigen::Vector3d(numbers[0], numbers[1], numbers[2]);
  return pose;
}

template <class Read>
auto whole(const Payload& payload, Read read) {
  Reading in(payload);
  auto message = read(in);
  in.end();
  return message;
}

}  // namespace

Payload image_payload(const FastHeader& header, const cv::Mat& pixels,
                      const std::string& encoding) {
  Writing out;
  put(out.cdr, header);
  out.cdr << static_cast<std::uint32_t>(pixels.rows) << static_cast<std::uint32_t>(pixels.cols);
  out.cdr << encoding << std::uint8_t{0};
  out.cdr << static_cast<std::uint32_t>(pixels.cols * static_cast<int>(pixels.elemSize()));
  out.cdr << std::vector<std::uint8_t>(pixels.data,
                                       pixels.data + pixels.total() * pixels.elemSize());
  return out.payload();
}

Payload camera_info_payload(const FastHeader& header, const Camera& camera) {
  Writing out;
  put(out.cdr, header);
  out.cdr << static_cast<std::uint32_t>(camera.height) << static_cast<std::uint32_t>(camera.width);
  out.cdr << std::string("plumb_bob") << std::vector<double>(5, 0.0);
  out.cdr << std::array<double, 9>{camera.fx, 0, camera.cx, 0, camera.fy, camera.cy, 0, 0, 1};
  out.cdr << std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1};
  out.cdr << std::array<double, 12>{camera.fx, 0, camera.cx, 0, 0, camera.fy,
                                    camera.cy, 0, 0,         0, 1, 0};
  out.cdr << std::array<std::uint32_t, 6>{} << false;  // binning, region of interest
  return out.payload();
}

std::vector<FastPose> read_transforms(const Payload& payload) {
  return whole(payload, [](Reading& in) {
    std::vector<FastPose> transforms(in.get<std::uint32_t>());
    for (FastPose& each : transforms) each = {header_of(in), in.get<std::string>(), pose_of(in)};
    return transforms;
  });
}

FastPose read_pose(const Payload& payload) {
  return whole(payload, [](Reading& in) { return FastPose{header_of(in), "", pose_of(in)}; });
}

FastOdometry read_odometry(const Payload& payload) {
  return whole(payload, [](Reading& in) {
    FastOdometry odometry{.pose = {header_of(in), in.get<std::string>(), pose_of(in)}};
    const auto covariance = in.get<std::array<double, 36>>();
    odometry.covariance = Matrix6d(covariance.data());  // symmetric
    const auto twist = in.get<std::array<double, 6>>();
    odometry.twist = Vector6d(twist.data());
    in.get<std::array<double, 36>>();
    return odometry;
  });
}

std::vector<FastPose> read_path(const Payload& payload) {
  return whole(payload, [](Reading& in) {
    header_of(in);
    std::vector<FastPose> poses(in.get<std::uint32_t>());
    for (FastPose& each : poses) each = {header_of(in), "", pose_of(in)};
    return poses;
  });
}

FastState read_state(const Payload& payload) {
  return whole(payload, [](Reading& in) {
    FastState state{in.get<std::uint8_t>(), in.get<std::string>(), in.get<std::string>(), {}};
    in.get<std::string>();  // hardware_id
    state.values.resize(in.get<std::uint32_t>());
    for (auto& [key, value] : state.values) in.cdr >> key >> value;
    return state;
  });
}

FastCloud read_cloud(const Payload& payload) {
  return whole(payload, [](Reading& in) {
    FastCloud cloud{.header = header_of(in)};
    in.get<std::uint32_t>();  // height
    cloud.width = in.get<std::uint32_t>();
    cloud.fields.resize(in.get<std::uint32_t>());
    for (std::string& name : cloud.fields) {
      in.cdr >> name;
      in.get<std::uint32_t>();  // offset
      in.get<std::uint8_t>();   // datatype
      in.get<std::uint32_t>();  // count
    }
    in.get<bool>();  // is_bigendian
    cloud.point_step = in.get<std::uint32_t>();
    in.get<std::uint32_t>();  // row_step
    in.cdr >> cloud.data;
    in.get<bool>();  // is_dense
    return cloud;
  });
}

FastGrid read_grid(const Payload& payload) {
  return whole(payload, [](Reading& in) {
    FastGrid grid{.header = header_of(in)};
    in.get<std::array<std::uint32_t, 2>>();  // map_load_time
    in.cdr >> grid.resolution >> grid.width >> grid.height;
    grid.header_from_origin = pose_of(in);
    in.cdr >> grid.cells;
    return grid;
  });
}

FastOctree read_octree(const Payload& payload) {
  return whole(payload, [](Reading& in) {
    FastOctree octree{.header = header_of(in)};
    in.cdr >> octree.binary >> octree.id >> octree.resolution >> octree.data;
    return octree;
  });
}

}  // namespace stillpoint::testing
