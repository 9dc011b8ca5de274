// Writes .sens files, version 4, byte by byte from the format's description.
#pragma once

#include <libdeflate.h>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "stillpoint/pose_math.hpp"
#include "stillpoint/support/image_codec.hpp"

namespace stillpoint::testing {

class SensWriter {
 public:
  struct Image {
    cv::Mat color, depth;
    std::uint64_t time = 0;  ///< microseconds
    std::optional<Pose> world_from_camera = Pose::Identity();
  };

  std::uint32_t version = 4;
  std::string sensor = "StructureSensor";
  cv::Size color_size{64, 48}, depth_size{64, 48};
  double color_focal = 60, depth_focal = 60;
  Pose color_from_depth = Pose::Identity();
  std::int32_t color_kind = 2, depth_kind = 1;  ///< JPEG, zlib
  float depth_unit = 1000;
  std::vector<Image> images;

  std::vector<std::uint8_t> bytes() {
    file_.clear();
    number(version);
    number(std::uint64_t{sensor.size()});
    file_.insert(file_.end(), sensor.begin(), sensor.end());
    matrix(intrinsics(color_focal, color_size));
    matrix(Eigen::Matrix4d::Identity());
    matrix(intrinsics(depth_focal, depth_size));
    matrix(color_from_depth.matrix());
    number(color_kind);
    number(depth_kind);
    for (const cv::Size size : {color_size, depth_size}) {
      number(static_cast<std::uint32_t>(size.width));
      number(static_cast<std::uint32_t>(size.height));
    }
    number(depth_unit);
    number(std::uint64_t{images.size()});
    for (const Image& image : images) frame(image);
    number(std::uint64_t{0});  // inertial measurements
    return file_;
  }

  std::filesystem::path save(const std::filesystem::path& file) {
    const auto content = bytes();
    std::ofstream(file, std::ios::binary)
        .write(reinterpret_cast<const char*>(content.data()),
               static_cast<std::streamsize>(content.size()));
    return file;
  }

 private:
  template <class Number>
  void number(Number value) {
    std::uint8_t raw[sizeof(Number)];
    std::memcpy(raw, &value, sizeof(Number));
    file_.insert(file_.end(), raw, raw + sizeof(Number));
  }
  void matrix(const Eigen::Matrix4d& values) {
    for (int row = 0; row < 4; ++row)
      for (int column = 0; column < 4; ++column) number(static_cast<float>(values(row, column)));
  }
  static Eigen::Matrix4d intrinsics(double focal, cv::Size size) {
    Eigen::Matrix4d result = Eigen::Matrix4d::Identity();
    result(0, 0) = result(1, 1) = focal;
    result(0, 2) = (size.width - 1) / 2.0;
    result(1, 2) = (size.height - 1) / 2.0;
    return result;
  }
  void frame(const Image& image) {
    const double lost = -std::numeric_limits<double>::infinity();
    matrix(image.world_from_camera ? image.world_from_camera->matrix()
                                   : Eigen::Matrix4d(Eigen::Matrix4d::Constant(lost)));
    const std::vector<std::uint8_t> color =
        encode_image(color_kind == 1 ? ".png" : ".jpg", image.color);
    const std::vector<std::uint8_t> depth = compressed(image.depth);
    for (const std::uint64_t value : {image.time, image.time + 1000}) number(value);
    number(std::uint64_t{color.size()});
    number(std::uint64_t{depth.size()});
    file_.insert(file_.end(), color.begin(), color.end());
    file_.insert(file_.end(), depth.begin(), depth.end());
  }
  std::vector<std::uint8_t> compressed(const cv::Mat& depth) const {
    const std::size_t size = 2 * depth.total();
    if (depth_kind == 0) return {depth.data, depth.data + size};
    auto* compressor = libdeflate_alloc_compressor(6);
    std::vector<std::uint8_t> result(libdeflate_zlib_compress_bound(compressor, size));
    result.resize(
        libdeflate_zlib_compress(compressor, depth.data, size, result.data(), result.size()));
    libdeflate_free_compressor(compressor);
    return result;
  }

  std::vector<std::uint8_t> file_;
};

}  // namespace stillpoint::testing
