// Bags, and the messages in them.
#include <functional>
#include <opencv2/core.hpp>

#include "bag/bag_reader.hpp"
#include "bag/camera_model.hpp"
#include "bag/frame_tree.hpp"
#include "bag/image_stamps.hpp"
#include "bag/raw_image.hpp"
#include "bag/topic_choice.hpp"
#include "fuzz/fuzz_target.hpp"
#include "support/bag_writer.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::testing {
namespace {

/// Two topics of images, a camera, and frames.
Bytes small_bag(const BagStyle& style) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / ("a." + style.format);
  const auto writer = make_bag_writer(file, style);
  const Serialisation kind = writer->serialisation();
  writer->add("/c/camera_info", "sensor_msgs/CameraInfo", 1, camera_info_message(kind));
  writer->add(
      "/tf", "tf2_msgs/TFMessage", 1,
      transforms_message(kind, {{"r", "c", Pose::Identity()}, {"r", "d", Pose::Identity()}}));
  for (std::int64_t time = 1; time < 5; ++time) {
    writer->add("/c/color", "sensor_msgs/Image", time,
                image_message(kind, time, "c", cv::Mat::zeros(2, 3, CV_8UC3), "rgb8"));
    writer->add("/c/depth", "sensor_msgs/Image", time,
                image_message(kind, time, "c", cv::Mat::zeros(2, 3, CV_16UC1), "16UC1"));
  }
  writer->finish();
  return bytes_of(file);
}

/// As what it is, and as what it is not.
void use_message(bag::ByteSpan message, Serialisation kind) {
  const auto use_image = [&](bool compressed_one) {
    const bag::ImageMessage image = bag::read_image(message, kind, compressed_one);
    image.description.kind() == bag::ImageKind::kDepth ? bag::depth_pixels(image)
                                                       : bag::color_pixels(image);
  };
  const std::function<void()> uses[] = {
      [&] { use_image(false); }, [&] { use_image(true); },
      [&] { bag::camera_model(bag::read_camera_info(message, kind), false, "camera"); },
      [&] { bag::read_transforms(message, kind); },
      [&] { bag::compressed_depth(bag::read_image(message, kind, true)); }};
  for (const auto& use : uses) {
    try {
      use();
    } catch (const Error&) {
    }
  }
}

void use_bag(const fs::path& file) {
  const auto bag = bag::open_bag(file);
  for (const bag::MessagePlace& place : bag->messages()) {
    try {
      use_message(bag->read(place), bag->topics()[place.topic].serialisation);
    } catch (const Error&) {
    }
  }
  const bag::TopicChoice choice = bag::choose_topics(*bag, {});
  bag::image_stamps(*bag, {choice.color, choice.depth});
  bag::camera_in_bag(*bag, choice.color);
  bag::FrameTree(*bag).target_from_source("c", "d");
}

FuzzTarget ros1_bag() {
  return {.seeds = {small_bag({"bag", "none"}), small_bag({"bag", "lz4"}),
                    small_bag({"bag", "bz2", 2, false})},
          .parse = use_bag,
          .words = {"op=", "conn=", "time=", "size=", "compression=none", "compression=bz2",
                    "chunk_pos=", "index_pos=", "topic=", "type=sensor_msgs/Image"}};
}

FuzzTarget mcap_file() {
  return {.seeds = {small_bag({"mcap", "none"}), small_bag({"mcap", "zstd"}),
                    small_bag({"mcap", "lz4", 2, false}), small_bag({"mcap", "none", 0})},
          .parse = use_bag,
          .words = {"\x89MCAP0\r\n", "zstd", "lz4", "cdr", "ros1", "ros2msg"}};
}

FuzzTarget ros2_database() {
  return {.seeds = {small_bag({"db3", "none"}), small_bag({"db3", "zstd"})},
          .parse = use_bag,
          .words = {"CREATE TABLE", "CREATE VIEW", "CREATE INDEX", "WITHOUT ROWID", "messages",
                    "topics"}};
}

/// The first byte says of which ROS the message behind it is.
FuzzTarget bag_message() {
  std::vector<Bytes> seeds;
  for (const Serialisation kind : {Serialisation::kRos1, Serialisation::kCdr})
    for (const Bytes& message :
         {image_message(kind, 5, "frame", cv::Mat::zeros(2, 3, CV_8UC3), "rgb8"),
          image_message(kind, 5, "frame", cv::Mat::zeros(2, 3, CV_16UC1), "16UC1"),
          compressed_message(kind, 5, "frame", "jpeg", {1, 2, 3}), camera_info_message(kind),
          transforms_message(kind, {{"a", "b", Pose::Identity()}, {"c", "d", Pose::Identity()}})}) {
      seeds.push_back({static_cast<std::uint8_t>(kind)});
      seeds.back().insert(seeds.back().end(), message.begin(), message.end());
    }
  return {.seeds = std::move(seeds),
          .parse =
              [](const fs::path& file) {
                const Bytes bytes = bytes_of(file);
                if (bytes.empty()) return;
                use_message(bag::ByteSpan(bytes).subspan(1),
                            bytes[0] % 2 == 0 ? Serialisation::kRos1 : Serialisation::kCdr);
              },
          .words = {"rgb8", "bayer_rggb8", "yuv422", "32FC1", "mono8", "plumb_bob"}};
}

}  // namespace

std::vector<NamedFuzzTarget> bag_targets() {
  return {{"Ros1Bag", ros1_bag},
          {"McapFile", mcap_file},
          {"Ros2Database", ros2_database},
          {"BagMessage", bag_message}};
}

}  // namespace stillpoint::testing
