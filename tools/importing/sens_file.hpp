// The .sens files of ScanNet: calibration, then one colour and one depth image after the other.
//
// Little-endian, without padding, version 4: u32 version; u64 length and characters of the sensor's
// name; four 4 x 4 float matrices by rows (intrinsics and extrinsics of colour, then of depth); i32
// compression of colour (0 raw RGB, 1 PNG, 2 JPEG) and of depth (0 raw u16, 1 zlib); u32 width and
// height of colour and of depth; float depth units of a metre; u64 number of frames. A frame: 4 x 4
// float camera-to-world; u64 times of colour and depth in us; u64 sizes of both; their bytes.
// Inertial data may follow, which is not read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::importing {

struct SensFrame {
  std::optional<Pose> world_from_depth;  ///< nothing where the camera was lost
  std::uint64_t color_time = 0;          ///< microseconds
  std::uint64_t depth_time = 0;          ///< microseconds
  std::uint64_t color_size = 0;          ///< bytes
  std::uint64_t depth_size = 0;          ///< bytes
  std::uint64_t offset = 0;              ///< of the colour image in the file
};

enum class SensColor : std::int32_t { kRaw = 0, kPng = 1, kJpeg = 2 };
enum class SensDepth : std::int32_t { kRaw = 0, kZlib = 1 };

class SensFile {
 public:
  /// Reads the calibration and what stands before the images of the first `most_frames` frames.
  /// Throws Error(kData) when the file is damaged, truncated or of another version.
  SensFile(std::filesystem::path file, std::size_t most_frames);

  const Camera& color_camera() const { return color_camera_; }
  const Camera& depth_camera() const { return depth_camera_; }
  const Pose& color_from_depth() const { return color_from_depth_; }
  double depth_factor() const { return depth_factor_; }  ///< value of one metre
  SensColor color_kind() const { return color_kind_; }
  const std::vector<SensFrame>& frames() const { return frames_; }

  /// As it stands in the file: an image file, or raw RGB. Throws Error(kData).
  std::vector<std::uint8_t> color(std::size_t index);
  /// CV_16UC1. Throws Error(kData).
  cv::Mat depth(std::size_t index);

 private:
  template <class Number>
  Number number(const char* what);
  Eigen::Matrix4d matrix(const char* what);
  Camera camera(const Eigen::Matrix4d& intrinsics, const char* whose) const;
  void read_header();
  void read_sizes();
  void read_frame_heads(std::size_t most_frames);
  std::vector<std::uint8_t> bytes(std::uint64_t offset, std::uint64_t size);

  std::filesystem::path file_;
  std::ifstream stream_;
  std::uint64_t file_size_ = 0;
  Camera color_camera_, depth_camera_;
  Pose color_from_depth_ = Pose::Identity();
  double depth_factor_ = 1000.0;
  SensColor color_kind_ = SensColor::kJpeg;
  SensDepth depth_kind_ = SensDepth::kZlib;
  std::uint64_t stated_frames_ = 0;
  std::vector<SensFrame> frames_;
};

}  // namespace stillpoint::importing
