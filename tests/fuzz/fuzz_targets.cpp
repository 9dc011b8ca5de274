#include "fuzz/fuzz_target.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <span>
#include <string_view>

#include "evaluation/trajectory.hpp"
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

FuzzTarget live_request() {
  return {.seeds = {{output_web::kProtocol, 1, 7}},
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
          {"Configuration", configuration},
          {"SavedMap", saved_map},
          {"LiveRequest", live_request},
          {"LiveAccess", live_access},
          {"LiveConnection", live_connection}};
}

}  // namespace stillpoint::testing
