// Small recordings in the layouts of other data sets, written from their public descriptions, and
// the reading of what became of them.
#pragma once

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "evaluation/trajectory.hpp"
#include "importing/layout.hpp"
#include "importing/recording_folder.hpp"
#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/error.hpp"
#include "support/image_io.hpp"
#include "support/recording_writer.hpp"
#include "tum_recording/image_reader.hpp"
#include "tum_recording/recording.hpp"

namespace stillpoint::importing {

namespace fs = std::filesystem;
using stillpoint::testing::TemporaryFolder;

/// What a part of the program says when it refuses; empty: it does not.
inline std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

inline cv::Mat flat_color(cv::Size size = {640, 480}, const cv::Scalar& bgr = {10, 100, 200}) {
  return {size, CV_8UC3, bgr};
}
inline cv::Mat flat_depth(int value, cv::Size size = {640, 480}) {
  return {size, CV_16UC1, cv::Scalar(value)};
}

inline void write_image(const fs::path& file, const cv::Mat& image) {
  fs::create_directories(file.parent_path());
  testing::write_image(file, image);
}

inline std::unique_ptr<ForeignRecording> open_foreign(const fs::path& recording,
                                                      ImportOptions options = {}) {
  const Layout& layout = layout_of(recording);
  if (!options.camera && layout.camera)
    options.camera = load_camera(std::string(STILLPOINT_SOURCE_DIR "/configs/cameras/") +
                                 layout.camera + ".yaml");
  return layout.open(recording, options);
}

/// A recording that was imported, read by the rest of the project.
class Imported {
 public:
  explicit Imported(const fs::path& recording, const ImportOptions& options = {}) {
    const auto foreign = open_foreign(recording, options);
    RecordingFolder folder(path());
    EXPECT_TRUE(add_frames(*foreign, folder, {}, [](std::size_t) {}));
    folder.commit(foreign->truth(), "version: 1\n" + camera_yaml(foreign->camera()));
    notes = foreign->notes();
    written = folder.written();
    read = tum_recording::open_recording(path());
    camera = load_camera((path() / "camera.yaml").string());
  }

  fs::path path() const { return folder_.path() / "out"; }
  cv::Mat color(std::size_t pair) const {
    return tum_recording::ImageReader().color(read.pairs.at(pair).color.file);
  }
  cv::Mat depth(std::size_t pair) const {
    return tum_recording::ImageReader().depth(read.pairs.at(pair).depth.file);
  }
  double metres(std::size_t pair, int x, int y) const {
    return depth(pair).at<std::uint16_t>(y, x) / camera.depth_factor;
  }
  std::vector<StampedPose> truth() const {
    return evaluation::read_trajectory(path() / "groundtruth.txt").poses;
  }

  tum_recording::Recording read;
  CameraModel camera;
  std::vector<std::string> notes;
  std::size_t written = 0;

 private:
  TemporaryFolder folder_;
};

/// A pose with nothing special about it.
inline Pose some_pose(int index) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3({0.1 + 0.01 * index, -0.2, 0.3});
  pose.translation() = Eigen::Vector3d(1 + 0.1 * index, 2, -3);
  return pose;
}

/// Four rows of four numbers.
inline std::string matrix_text(const Eigen::Matrix4d& matrix) {
  std::string text;
  for (int row = 0; row < 4; ++row) {
    char line[128];
    std::snprintf(line, sizeof(line), "%.9f\t%.9f\t%.9f\t%.9f\t\n", matrix(row, 0), matrix(row, 1),
                  matrix(row, 2), matrix(row, 3));
    text += line;
  }
  return text;
}

/// "number tx ty tz qx qy qz qw", or with w first and commas.
inline std::string pose_text(const std::string& number, const Pose& pose, bool commas = false) {
  const Eigen::Quaterniond q(pose.linear());
  const Eigen::Vector3d t = pose.translation();
  char line[256];
  if (commas)
    std::snprintf(line, sizeof(line), "%s,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,%.9f,0,0,0\n",
                  number.c_str(), t.x(), t.y(), t.z(), q.w(), q.x(), q.y(), q.z());
  else
    std::snprintf(line, sizeof(line), "%s %.9f %.9f %.9f %.9f %.9f %.9f %.9f\n", number.c_str(),
                  t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  return line;
}

inline void expect_pose(const Pose& actual, const Pose& expected) {
  EXPECT_LT((expected.inverse() * actual).matrix().operator-(Eigen::Matrix4d::Identity()).norm(),
            1e-5)
      << actual.matrix() << "\n\n"
      << expected.matrix();
}

}  // namespace stillpoint::importing
