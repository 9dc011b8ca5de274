#include "importing/sens_file.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <utility>

#include "importing/matrix_pose.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::importing {
namespace {

constexpr std::uint32_t kSensVersion = 4;
constexpr std::uint64_t kLongestName = 4096;   // bytes
constexpr std::uint32_t kLargestSide = 16384;  // px
constexpr std::uint64_t kFrameHead = 16 * 4 + 4 * 8;
// A few bytes can state gigabytes; deflate makes no more than this of one (zlib's documentation).
constexpr std::uint64_t kLargestExpansion = 1032;

[[noreturn]] void fail_sens(const std::filesystem::path& file, const std::string& problem,
                            const std::string& remedy = {}) {
  throw Error(Fault::kData, problem, file.string(), remedy);
}

}  // namespace

SensFile::SensFile(std::filesystem::path file, std::size_t most_frames)
    : file_(std::move(file)), stream_(file_, std::ios::binary) {
  std::error_code error;
  file_size_ = std::filesystem::file_size(file_, error);
  if (!stream_ || error) fail_sens(file_, "cannot be opened");
  read_header();
  read_frame_heads(most_frames);
}

template <class Number>
Number SensFile::number(const char* what) {
  Number value{};
  if (!stream_.read(reinterpret_cast<char*>(&value), sizeof(value)))
    fail_sens(file_, std::string("ends before ") + what, "is it a whole .sens file?");
  return value;
}

Eigen::Matrix4d SensFile::matrix(const char* what) {
  Eigen::Matrix4d result;
  for (int row = 0; row < 4; ++row)
    for (int column = 0; column < 4; ++column)
      result(row, column) = static_cast<double>(number<float>(what));
  return result;
}

Camera SensFile::camera(const Eigen::Matrix4d& intrinsics, const char* whose) const {
  Camera result;
  result.fx = intrinsics(0, 0);
  result.fy = intrinsics(1, 1);
  result.cx = intrinsics(0, 2);
  result.cy = intrinsics(1, 2);
  if (!intrinsics.allFinite() || result.fx <= 0 || result.fy <= 0)
    fail_sens(file_, std::string("has no calibration of the ") + whose + " camera");
  return result;
}

void SensFile::read_header() {
  if (const auto version = number<std::uint32_t>("its version"); version != kSensVersion)
    fail_sens(file_,
              "is no .sens file of version 4 (its version is " + std::to_string(version) + ")");
  const auto length = number<std::uint64_t>("the name of the sensor");
  if (length > kLongestName)
    fail_sens(file_, "is damaged: a sensor with a name of " + std::to_string(length) + " bytes");
  stream_.ignore(static_cast<std::streamsize>(length));
  color_camera_ = camera(matrix("the calibration"), "colour");
  const Eigen::Matrix4d color_extrinsics = matrix("the calibration");
  depth_camera_ = camera(matrix("the calibration"), "depth");
  const auto color_from_depth = pose_of(matrix("the calibration"));
  if (!color_extrinsics.isIdentity(1e-6) || !color_from_depth)
    fail_sens(file_, "says of where the cameras are to each other what cannot be used",
              "the extrinsics of colour should be the identity, those of depth a rigid motion");
  color_from_depth_ = *color_from_depth;
  read_sizes();
}

void SensFile::read_sizes() {
  color_kind_ = SensColor{number<std::int32_t>("the kind of its colour images")};
  depth_kind_ = SensDepth{number<std::int32_t>("the kind of its depth images")};
  if (color_kind_ < SensColor::kRaw || color_kind_ > SensColor::kJpeg)
    fail_sens(file_, "has colour images of an unknown kind", "raw, PNG and JPEG can be read");
  if (depth_kind_ != SensDepth::kRaw && depth_kind_ != SensDepth::kZlib)
    fail_sens(file_, "has depth images of an unknown kind",
              "raw and zlib can be read; files of OpenNI's compression cannot");
  const auto side = [this] {
    const auto pixels = number<std::uint32_t>("the size of its images");
    if (pixels == 0 || pixels > kLargestSide)
      fail_sens(file_, "is damaged: an image side of " + std::to_string(pixels) + " px");
    return static_cast<int>(pixels);
  };
  for (Camera* of : {&color_camera_, &depth_camera_}) {
    of->width = side();
    of->height = side();
  }
  depth_factor_ = static_cast<double>(number<float>("the unit of depth"));
  if (!std::isfinite(depth_factor_) || depth_factor_ <= 0)
    fail_sens(file_, "is damaged: the unit of depth is " + std::to_string(depth_factor_));
  stated_frames_ = number<std::uint64_t>("the number of frames");
}

void SensFile::read_frame_heads(std::size_t most_frames) {
  const std::uint64_t wanted = std::min<std::uint64_t>(stated_frames_, most_frames);
  auto at = static_cast<std::uint64_t>(stream_.tellg());
  while (frames_.size() < wanted) {
    SensFrame frame;
    const bool has_head = file_size_ - at >= kFrameHead;
    if (has_head) {
      stream_.seekg(static_cast<std::streamoff>(at));
      frame.world_from_depth = pose_of(matrix("a pose"));
      for (std::uint64_t* value :
           {&frame.color_time, &frame.depth_time, &frame.color_size, &frame.depth_size})
        *value = number<std::uint64_t>("a frame");
      frame.offset = at + kFrameHead;
    }
    const std::uint64_t left = has_head ? file_size_ - frame.offset : 0;
    if (!has_head || frame.color_size > left || frame.depth_size > left - frame.color_size)
      fail_sens(file_,
                "ends within frame " + std::to_string(frames_.size() + 1) + " of " +
                    std::to_string(stated_frames_),
                frames_.empty() ? "load it anew"
                                : "load it anew, or take what is whole: --frames " +
                                      std::to_string(frames_.size()));
    at = frame.offset + frame.color_size + frame.depth_size;
    frames_.push_back(frame);
  }
  if (frames_.empty()) fail_sens(file_, "has no frames");
}

std::vector<std::uint8_t> SensFile::bytes(std::uint64_t offset, std::uint64_t size) {
  std::vector<std::uint8_t> result(size);
  stream_.seekg(static_cast<std::streamoff>(offset));
  if (!stream_.read(reinterpret_cast<char*>(result.data()), static_cast<std::streamsize>(size)))
    fail_sens(file_, "cannot be read");
  return result;
}

std::vector<std::uint8_t> SensFile::color(std::size_t index) {
  const SensFrame& frame = frames_.at(index);
  return bytes(frame.offset, frame.color_size);
}

cv::Mat SensFile::depth(std::size_t index) {
  const SensFrame& frame = frames_.at(index);
  const std::string whose = "the depth image of frame " + std::to_string(index + 1);
  const auto stored = bytes(frame.offset + frame.color_size, frame.depth_size);
  const std::uint64_t size =
      std::uint64_t{2} * static_cast<unsigned>(depth_camera_.width * depth_camera_.height);
  const std::uint64_t most =
      depth_kind_ == SensDepth::kRaw ? stored.size() : stored.size() * kLargestExpansion;
  if (size > most) fail_sens(file_, whose + " is too short");
  cv::Mat image(depth_camera_.height, depth_camera_.width, CV_16UC1);
  if (depth_kind_ == SensDepth::kRaw) {
    std::memcpy(image.data, stored.data(), size);
    return image;
  }
  const std::unique_ptr<libdeflate_decompressor, decltype(&libdeflate_free_decompressor)>
      decompressor(libdeflate_alloc_decompressor(), libdeflate_free_decompressor);
  std::size_t actual = 0;
  if (libdeflate_zlib_decompress(decompressor.get(), stored.data(), stored.size(), image.data, size,
                                 &actual) != LIBDEFLATE_SUCCESS ||
      actual != size)
    fail_sens(file_, whose + " cannot be decompressed");
  return image;
}

}  // namespace stillpoint::importing
