#include "simulation/recording_writer.hpp"

#include <array>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "simulation/out_of_memory.hpp"
#include "simulation/png_file.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::simulation {
namespace {

std::string seconds(double time) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.6f", time);
  return text.data();
}

void make_folders(const std::filesystem::path& folder, bool labels) {
  for (const char* name :
       {"rgb.txt", "depth.txt", "associations.txt", "groundtruth.txt", "camera.yaml"})
    if (std::error_code none; std::filesystem::exists(folder / name, none))
      throw Error(Fault::kUsage, "there is a recording already, or a part of one",
                  (folder / name).string(), "name another folder or remove this one");
  std::vector<const char*> names = {"rgb", "depth"};
  if (labels) names.insert(names.end(), {"labels", "instances"});
  for (const char* name : names) {
    std::error_code error;
    std::filesystem::create_directories(folder / name, error);
    if (error)
      throw Error(Fault::kUsage, "cannot make the folder (" + error.message() + ")",
                  (folder / name).string(), "name another one");
  }
}

}  // namespace

RecordingWriter::RecordingWriter(const std::filesystem::path& folder, bool labels)
    : folder_(folder), labels_(labels) {
  make_folders(folder_, labels_);
  colors_ = open("rgb.txt", "# color images\n# timestamp filename\n");
  depths_ = open("depth.txt", "# depth maps\n# timestamp filename\n");
  associations_ = open("associations.txt", "");
}

std::ofstream RecordingWriter::open(const char* name, const char* header) const {
  std::ofstream file(folder_ / name);
  if (!(file << header << std::flush))
    throw Error(Fault::kUsage, "cannot write", (folder_ / name).string(), "name another folder");
  return file;
}

void RecordingWriter::write(const SimulatedFrame& frame) try {
  list(frame.index, write_images(frame));
} catch (...) {
  rethrow_named();
}

RecordingWriter::Names RecordingWriter::write_images(const SimulatedFrame& frame) const {
  const std::string color_name = seconds(frame.time) + ".png";
  const std::string depth_name = seconds(frame.depth_time) + ".png";
  write_png(folder_ / "rgb" / color_name, frame.bgr);
  write_png(folder_ / "depth" / depth_name, frame.depth);
  if (labels_) {
    write_png(folder_ / "labels" / color_name, frame.labels);
    write_png(folder_ / "instances" / color_name, frame.instances);
  }
  return {seconds(frame.time) + " rgb/" + color_name,
          seconds(frame.depth_time) + " depth/" + depth_name};
}

void RecordingWriter::list(int index, const Names& names) {
  const std::scoped_lock lock(mutex_);
  waiting_[index] = names;
  for (; waiting_.contains(listed_); ++listed_) {
    const auto [color, depth] = waiting_.extract(listed_).mapped();
    colors_ << color << '\n';
    depths_ << depth << '\n';
    associations_ << color << ' ' << depth << '\n';
  }
  // Flushed, so that what an interrupted run has written is a recording.
  if (!colors_.flush() || !depths_.flush() || !associations_.flush())
    throw Error(Fault::kUsage, "cannot write the lists of images", folder_.string(),
                "is the disk full?");
}

void RecordingWriter::write_ground_truth(const Simulator& simulator, int frames) {
  constexpr double kRate = 100;  // Hz
  std::ofstream file =
      open("groundtruth.txt", "# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n");
  const auto first = static_cast<long>(std::floor(simulator.stamp(0) * kRate)) - 5;
  const auto last = static_cast<long>(std::ceil(simulator.stamp(frames - 1) * kRate)) + 5;
  for (long i = first; i <= last; ++i) {
    const double time = static_cast<double>(i) / kRate;
    const Pose pose = simulator.world_from_camera(time);
    const Eigen::Quaterniond q(pose.linear());
    std::array<char, 192> line{};
    std::snprintf(line.data(), line.size(), "%.4f %.6f %.6f %.6f %.7f %.7f %.7f %.7f\n", time,
                  pose.translation().x(), pose.translation().y(), pose.translation().z(), q.x(),
                  q.y(), q.z(), q.w());
    file << line.data();
  }
  if (!file.flush())
    throw Error(Fault::kUsage, "cannot write", (folder_ / "groundtruth.txt").string(),
                "is the disk full?");
}

}  // namespace stillpoint::simulation
