// Frames of any source, as they are written by `stillpoint record`.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>

#include "ros2_messages/mcap_writer.hpp"
#include "simulation/recording_writer.hpp"
#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/contracts/output.hpp"

namespace stillpoint {

/// Throws Error(kUsage) unless the target is an empty folder or not there.
void require_new(const std::filesystem::path& target);

/// A folder of the TUM RGB-D benchmark with camera.yaml. At any moment its lists name the images
/// that are there.
class FolderRecorder final : public Output {
 public:
  /// Depth is written in units of `sensor`. Throws Error(kUsage) when the folder cannot be made.
  FolderRecorder(std::filesystem::path folder, CameraModel sensor);
  void frame(const FrameReport& report) override;
  /// Leaves nothing behind.
  void ended_before_first_frame(const RunSummary& summary) override;

 private:
  void write_camera(const Camera& camera) const;

  std::filesystem::path folder_;
  CameraModel sensor_;
  simulation::RecordingWriter writer_;
  int recorded_ = 0;
};

/// An MCAP file with messages of ROS 2: colour as bgr8, depth as 32FC1 in metres, both with their
/// camera.
class McapRecorder final : public Output {
 public:
  /// Throws Error(kUsage) when the folder of the file cannot be made.
  explicit McapRecorder(const std::filesystem::path& file);
  void frame(const FrameReport& report) override;
  void finish(const RunSummary& summary) override;
  /// Leaves nothing behind: the file begins with the first frame.
  void ended_before_first_frame(const RunSummary&) override {}

 private:
  ros2_messages::McapWriter writer_;
  ros2_messages::ChannelId color_, color_camera_, depth_, depth_camera_;
};

/// By the name: what ends in .mcap is a file, all else a folder.
std::shared_ptr<Output> make_recorder(const std::filesystem::path& target,
                                      const CameraModel& sensor);

}  // namespace stillpoint
