#include "recorders.hpp"

#include <string>
#include <utility>

#include "ros2_messages/frames.hpp"
#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/raw_depth.hpp"
#include "stillpoint/support/rectifier.hpp"

namespace stillpoint {
namespace {

namespace mcap = ros2_messages;

std::filesystem::path in_made_folder(const std::filesystem::path& file) {
  std::error_code error;
  if (file.has_parent_path()) std::filesystem::create_directories(file.parent_path(), error);
  if (error)
    throw Error(Fault::kUsage, "cannot make the folder (" + error.message() + ")",
                file.parent_path().string(), "name another one");
  return file;
}

}  // namespace

void require_new(const std::filesystem::path& target) {
  std::error_code error;  // of a folder that is none, which is told later
  const auto status = std::filesystem::status(target, error);
  if (!std::filesystem::exists(status)) return;
  if (std::filesystem::is_directory(status) && std::filesystem::is_empty(target, error)) return;
  throw Error(Fault::kUsage, "there is something already", target.string(),
              "name another target or remove this one");
}

FolderRecorder::FolderRecorder(std::filesystem::path folder, CameraModel sensor)
    : folder_(std::move(folder)), sensor_(std::move(sensor)), writer_(folder_, false) {}

void FolderRecorder::frame(const FrameReport& report) {
  const Frame& frame = *report.frame;
  if (recorded_ == 0) write_camera(*frame.camera);
  writer_.write({.index = recorded_++,
                 .time = frame.time,
                 .depth_time = frame.time,
                 .bgr = frame.bgr,
                 .depth = raw_depth(frame.depth, sensor_.depth_factor)});
}

// By their names: whatever else is there is not the recorder's.
void FolderRecorder::ended_before_first_frame(const RunSummary&) {
  std::error_code ignored;
  for (const char* name :
       {"rgb.txt", "depth.txt", "associations.txt", "groundtruth.txt", "rgb", "depth", ""})
    std::filesystem::remove(folder_ / name, ignored);
}

/// Sources give images without distortion, and cropped.
void FolderRecorder::write_camera(const Camera& camera) const {
  AtomicFile file(folder_ / "camera.yaml");
  file.stream() << "version: 1\n" << camera_yaml(rectified(sensor_, camera));
  file.commit();
}

// Topics as of a RealSense's ROS node.
McapRecorder::McapRecorder(const std::filesystem::path& file)
    : writer_(in_made_folder(file)),
      color_(writer_.add_channel<mcap::Image>("/camera/color/image_raw")),
      color_camera_(writer_.add_channel<mcap::CameraInfo>("/camera/color/camera_info")),
      depth_(writer_.add_channel<mcap::Image>("/camera/aligned_depth_to_color/image_raw")),
      depth_camera_(
          writer_.add_channel<mcap::CameraInfo>("/camera/aligned_depth_to_color/camera_info")) {}

void McapRecorder::frame(const FrameReport& report) {
  const Frame& frame = *report.frame;
  const mcap::Header header{frame.time, mcap::kCameraFrame};
  const mcap::CameraInfo camera{header, *frame.camera};
  writer_.write(color_, frame.time, mcap::Image{header, frame.bgr});
  writer_.write(color_camera_, frame.time, camera);
  writer_.write(depth_, frame.time, mcap::Image{header, frame.depth});
  writer_.write(depth_camera_, frame.time, camera);
}

void McapRecorder::finish(const RunSummary&) { writer_.finish(); }

std::shared_ptr<Output> make_recorder(const std::filesystem::path& target,
                                      const CameraModel& sensor) {
  if (target.extension() == ".mcap") return std::make_shared<McapRecorder>(target);
  return std::make_shared<FolderRecorder>(target, sensor);
}

}  // namespace stillpoint
