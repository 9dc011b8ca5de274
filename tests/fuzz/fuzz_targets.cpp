#include "fuzz/fuzz_target.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <string_view>

#include "bag/camera_model.hpp"
#include "bag/image_stamps.hpp"
#include "bag/raw_image.hpp"
#include "bag/topic_choice.hpp"
#include "evaluation/trajectory.hpp"
#include "importing/matrix_pose.hpp"
#include "importing/sens_file.hpp"
#include "importing/sens_writer.hpp"
#include "output_web/access.hpp"
#include "output_web/request.hpp"
#include "output_web/test_viewer.hpp"
#include "output_web/web_output.hpp"
#include "segmenter_segnet/caffe_weights.hpp"
#include "segmenter_segnet/network_definition.hpp"
#include "segmenter_segnet/test_network.hpp"
#include "semantic_octree/octree_reader.hpp"
#include "semantic_octree/test_map.hpp"
#include "stillpoint/engine/map_file.hpp"
#include "stillpoint/runtime/plugin_stamp.hpp"
#include "stillpoint/runtime/yaml_loader.hpp"
#include "stillpoint/testing/test_recording.hpp"
#include "support/bag_writer.hpp"
#include "support/recording_writer.hpp"
#include "tum_recording/image_size.hpp"
#include "tum_recording/png_decoder.hpp"
#include "tum_recording/stamp_list.hpp"

namespace stillpoint::testing {
namespace {

using semantic_octree::read_octree;
using semantic_octree::TestMap;
using tum_recording::PngDecoder;
using tum_recording::read_image_list;
using tum_recording::stated_size;

namespace fs = std::filesystem;

Bytes bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

Bytes bytes_of_text(std::string_view text) { return {text.begin(), text.end()}; }

void append_number(Bytes& file, std::uint32_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    file.push_back(static_cast<std::uint8_t>(value >> shift));
}

std::uint32_t number_at(const Bytes& file, std::size_t at) {
  return static_cast<std::uint32_t>(file[at]) << 24 | file[at + 1] << 16 | file[at + 2] << 8 |
         file[at + 3];
}

Bytes encoded(const std::string& kind, int type) {
  cv::Mat image(6, 9, type);
  cv::RNG(7).fill(image, cv::RNG::UNIFORM, 0, 256);
  Bytes file;
  cv::imencode(kind, image, file);
  return file;
}

constexpr int kMostPixels = 1 << 20;      // ImageReader refuses what is too large
constexpr std::size_t kPngSignature = 8;  // bytes

/// The CRC of every chunk that is whole.
void repair_png(Bytes& file) {
  std::size_t at = kPngSignature;
  while (at + 12 <= file.size()) {
    const std::size_t size = number_at(file, at);
    if (size > file.size() - at - 12) return;
    Bytes crc;
    append_number(crc, libdeflate_crc32(0, &file[at + 4], size + 4));
    std::ranges::copy(crc, file.begin() + static_cast<std::ptrdiff_t>(at + 8 + size));
    at += size + 12;
  }
}

void append_chunk(Bytes& file, std::string_view name, const Bytes& data) {
  append_number(file, static_cast<std::uint32_t>(data.size()));
  file.insert(file.end(), name.begin(), name.end());
  file.insert(file.end(), data.begin(), data.end());
  append_number(file, 0);
}

/// 13 bytes of a header, and what is behind them compressed: what a PNG holds before its filters
/// are undone.
Bytes png_of(const Bytes& parts) {
  constexpr std::size_t kHeader = 13;
  if (parts.size() < kHeader) return parts;
  const std::span<const std::uint8_t> pixels(parts.begin() + kHeader, parts.end());
  const std::unique_ptr<libdeflate_compressor, decltype(&libdeflate_free_compressor)> compressor(
      libdeflate_alloc_compressor(1), libdeflate_free_compressor);
  Bytes data(libdeflate_zlib_compress_bound(compressor.get(), pixels.size()));
  data.resize(libdeflate_zlib_compress(compressor.get(), pixels.data(), pixels.size(), data.data(),
                                       data.size()));
  Bytes file = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(file, "IHDR", {parts.begin(), parts.begin() + kHeader});
  append_chunk(file, "IDAT", data);
  append_chunk(file, "IEND", {});
  repair_png(file);
  return file;
}

void decode(const Bytes& png) {
  const auto size = PngDecoder::stated_size(png);
  if (size && std::int64_t{size->width} * size->height < kMostPixels) PngDecoder().decode(png);
}

FuzzTarget png() {
  return {.seeds = {encoded(".png", CV_8UC1), encoded(".png", CV_8UC3), encoded(".png", CV_16UC1)},
          .parse = [](const fs::path& file) { decode(bytes_of(file)); },
          .repair = repair_png,
          .words = {"IHDR", "IDAT", "IEND", "PLTE", "tRNS"}};
}

FuzzTarget png_pixels() {
  const auto picture = [](std::uint8_t bits, std::uint8_t color) {
    Bytes parts = {0, 0, 0, 4, 0, 0, 0, 3, bits, color, 0, 0, 0};
    const int bytes = 4 * (color == 2 ? 3 : 1) * bits / 8;
    for (std::uint8_t row = 0; row < 3; ++row) {
      parts.push_back(row);
      for (int i = 0; i < bytes; ++i) parts.push_back(static_cast<std::uint8_t>(37 * i));
    }
    return parts;
  };
  return {.seeds = {picture(8, 0), picture(8, 2), picture(16, 0)},
          .parse = [](const fs::path& file) { decode(png_of(bytes_of(file))); }};
}

FuzzTarget image_size() {
  return {.seeds = {encoded(".png", CV_8UC3), encoded(".jpg", CV_8UC3)},
          .parse = [](const fs::path& file) { stated_size(bytes_of(file)); },
          .words = {"\xff\xd8", "\xff\xc0", "\xff\xe0", "\xff\xff"}};
}

FuzzTarget octree() {
  const TemporaryFolder folder;
  TestMap({}, {.resolution = 0.4}).save(folder.path());
  return {.seeds = {bytes_of(folder.path() / "map.ot"), bytes_of(folder.path() / "map.bt")},
          .parse = [](const fs::path& file) { read_octree(file); },
          .words = {"# Octomap OcTree file\n", "# Octomap OcTree binary file\n", "id OcTree\n",
                    "id ColorOcTree\n", "size 99999999\n", "res 0.05\n", "data\n",
                    "# stillpoint classes 1\n", "occupied_above"}};
}

FuzzTarget caffe_weights() {
  const auto network = segmenter_segnet::segnet_basic(32, 32, 1, 2, 1);
  return {.seeds = {bytes_of_text(network.caffemodel()),
                    bytes_of_text(network.caffemodel(segmenter_segnet::ModelFormat::kV1))},
          .parse = [](const fs::path& file) { segmenter_segnet::read_caffe_weights(file); }};
}

FuzzTarget network_definition() {
  return {.seeds = {bytes_of_text(segmenter_segnet::segnet_basic(32, 32, 1, 2, 1).prototxt())},
          .parse = [](const fs::path& file) { segmenter_segnet::read_definition(file); },
          .words = {"layer {", "}", "{", ":", "\"", "input_dim: 4294967296", "#", "include {",
                    "phase: TRAIN", "\\"}};
}

FuzzTarget plugin_stamp() {
  return {.seeds = {bytes_of(fs::path(STILLPOINT_BINARY_DIR) /
                             "tests/plugins_bad/plugins/libstillpoint_good.so")},
          .parse = [](const fs::path& file) { why_library_does_not_fit(file); },
          .words = {"\x7f"
                    "ELF",
                    "stillpoint_plugin_stamp", "api 99999999999\n", "abi \n"}};
}

FuzzTarget stamp_list() {
  return {.seeds = {bytes_of_text("# color images\n1305031102.175304 rgb/1305031102.175304.png\n"
                                  "1305031102.211214,\trgb/1305031102.211214.png\n")},
          .parse =
              [](const fs::path& file) {
                std::vector<std::string> warnings;
                read_image_list(file, warnings);
              },
          .words = {"nan", "inf", "1e308", "1e-400", "-", "\n", "\r\n", "#", ",", "\t",
                    std::string(1, '\0')}};
}

FuzzTarget trajectory() {
  return {.seeds = {bytes_of_text("# time tx ty tz qx qy qz qw\n1.5 0 1 2 0 0 0 1\n"
                                  "1.6 0.25 -1e-3 2.5 0.1 0.2 0.3 0.9\n"),
                    bytes_of_text("#timestamp, p_RS_R_x [m]\n"
                                  "1403636580838555648,1,2,3,1,0,0,0,0,0,0,0,0,0,0,0,0\n"
                                  "1403636580843555328,1,2,3,1,0,0,0,0,0,0,0,0,0,0,0,0\n"),
                    bytes_of_text("1 0 0 0 0 1 0 0 0 0 1 0\n0 -1 0 4 1 0 0 5 0 0 1 6\n")},
          .parse =
              [](const fs::path& file) {
                const auto trajectory = evaluation::read_trajectory(file);
                evaluation::pose_at(trajectory, 1.55);
                evaluation::median_interval(trajectory);
              },
          .words = {"nan", "inf", "1e308", "1e-400", "-", "\n", "\r\n", "#", ",", "0 0 0 0"}};
}

FuzzTarget sens() {
  const auto file = [](std::int32_t color_kind, std::int32_t depth_kind) {
    SensWriter writer;
    writer.color_size = writer.depth_size = {9, 6};
    writer.color_kind = color_kind;
    writer.depth_kind = depth_kind;
    const cv::Mat color(6, 9, CV_8UC3, cv::Scalar(1, 2, 3)), depth(6, 9, CV_16UC1, cv::Scalar(900));
    writer.images = {{.color = color, .depth = depth, .time = 1},
                     {.color = color, .depth = depth, .time = 2, .world_from_camera = {}}};
    return writer.bytes();
  };
  return {.seeds = {file(1, 0), file(2, 1)}, .parse = [](const fs::path& path) {
            importing::SensFile recording(path, 4);
            for (std::size_t i = 0; i < recording.frames().size(); ++i) {
              recording.color(i);
              recording.depth(i);
            }
          }};
}

FuzzTarget matrix_pose() {
  return {.seeds = {bytes_of_text("1 0 0 0.5\n0 1 0 -2e-3\n0 0 1 3\n0 0 0 1\n")},
          .parse = [](const fs::path& file) { importing::read_matrix_pose(file); },
          .words = {"nan", "-inf", "-1.#IND", "1e400", "1e308", "\n", "\t", "+", "-"}};
}

FuzzTarget configuration() {
  return {
      .seeds = {bytes_of_text("version: 1\nextends: " STILLPOINT_SOURCE_DIR
                              "/configs/pipelines/stillpoint.yaml\ncamera: tum_fr1\n"
                              "source: &s {type: tum_rgbd, path: \"${HOME}\"}\n"
                              "outputs: [{type: images, of: [1, 2]}]\n"
                              "tracker:\n  features: 1000\n  text: |\n    a\n    b\n")},
      .parse =
          [](const fs::path& file) {
            FaultList faults;
            ConfigNode node = load_config_file(file, "pipelines", faults);
            substitute_environment(node, faults);
            faults.throw_if_any();
          },
      .words = {"extends: ", "&a ", "*a",     "*s", "<<: ", "- ",    "{",     "}",           "[",
                "]",         "? ",  "!!str ", "|",  ">",    "---\n", "...\n", "%YAML 1.2\n", "${",
                "}",         ": ",  "\n  ",   ", ", "'",    "\"",    "\\x"}};
}

FuzzTarget saved_map() {
  const TemporaryFolder folder;
  MapEdit map{SparseMap()};
  KeyFrame keyframe{.id = 0, .camera = std::make_shared<const Camera>()};
  keyframe.features = std::make_shared<const Features>(
      Features{.keypoints = {{}}, .descriptors = {{}}, .depth = {1}});
  keyframe.track_weights = keyframe.map_weights = {255};
  keyframe.landmarks = {kNoId};
  map.add_keyframe(std::move(keyframe));
  const LandmarkId landmark = map.add_landmark({.reference = 0});
  map.add_observation(landmark, {.keyframe = 0, .feature = 0});
  save_map(map.map(), folder.path() / "map.stillpoint");
  return {.seeds = {bytes_of(folder.path() / "map.stillpoint")},
          .parse = [](const fs::path& file) { load_map(file); },
          .words = {"CREATE TABLE", "CREATE VIEW", "CREATE TRIGGER", "keyframe"}};
}

/// Two topics of images and a camera.
Bytes small_bag(const BagStyle& style) {
  const TemporaryFolder folder;
  const fs::path file = folder.path() / ("a." + style.format);
  const auto writer = make_bag_writer(file, style);
  const Serialisation kind = writer->serialisation();
  writer->add("/c/camera_info", "sensor_msgs/CameraInfo", 1, camera_info_message(kind));
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
      [&] { bag::camera_model(bag::read_camera_info(message, kind), false, "camera"); }};
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
  bag::camera_in_bag(*bag, choice);
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
          compressed_message(kind, 5, "frame", "jpeg", {1, 2, 3}), camera_info_message(kind)}) {
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

FuzzTarget live_request() {
  return {.seeds = {{output_web::kProtocol, 1, 15}, {output_web::kProtocol, 2, 5}},
          .parse = [](const fs::path& file) { output_web::parse_request(bytes_of(file)); }};
}

/// Target, host and origin, a line each.
FuzzTarget live_access() {
  return {.seeds = {bytes_of_text("/live?token=s3cret\nlocalhost:8080\nhttp://localhost:8080"),
                    bytes_of_text("/?a=b&token=s3cret\n[::1]:8080\nhttps://[::1]:8080")},
          .parse =
              [](const fs::path& file) {
                std::ifstream stream(file);
                std::string target, host, origin;
                std::getline(stream, target);
                std::getline(stream, host);
                std::getline(stream, origin);
                for (const char* address : {"127.0.0.1", "0.0.0.0"})
                  output_web::Access(address, "s3cret")
                      .refusal({.target = target, .host = host, .origin = origin});
              },
          .words = {"token=", "&", "?", "localhost", "[", "]", ":", "http://", "127.0.0.1"}};
}

/// Whatever a stranger sends, to a server of which the next one asks again.
FuzzTarget live_connection() {
  const auto output = std::make_shared<output_web::WebOutput>(
      output_web::WebOutput::Options{.port = 0}, test_context());
  const std::string upgrade =
      "GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  const std::string ask("\x82\x83\0\0\0\0\x01\x01\x07", 9);
  return {.seeds = {bytes_of_text(upgrade + ask),
                    bytes_of_text("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n")},
          .parse =
              [output](const fs::path& file) {
                const Bytes bytes = bytes_of(file);
                output_web::TestConnection connection(output_web::port_of(output->url()));
                connection.send({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
                connection.end();
                connection.rest();
              },
          .words = {"\r\n", ": ", "Upgrade", "Content-Length: ", "Transfer-Encoding: chunked",
                    "HTTP/1.1", "Sec-WebSocket-Extensions: permessage-deflate", "\x88", "\x89",
                    "\xff"}};
}

}  // namespace

std::vector<NamedFuzzTarget> fuzz_targets() {
  return {{"Png", png},
          {"PngPixels", png_pixels},
          {"ImageSize", image_size},
          {"Octree", octree},
          {"CaffeWeights", caffe_weights},
          {"NetworkDefinition", network_definition},
          {"PluginStamp", plugin_stamp},
          {"StampList", stamp_list},
          {"Trajectory", trajectory},
          {"Sens", sens},
          {"MatrixPose", matrix_pose},
          {"Configuration", configuration},
          {"SavedMap", saved_map},
          {"Ros1Bag", ros1_bag},
          {"McapFile", mcap_file},
          {"Ros2Database", ros2_database},
          {"BagMessage", bag_message},
          {"LiveRequest", live_request},
          {"LiveAccess", live_access},
          {"LiveConnection", live_connection}};
}

}  // namespace stillpoint::testing
