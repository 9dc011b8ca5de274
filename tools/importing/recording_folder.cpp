#include "importing/recording_folder.hpp"

#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <system_error>

#include "stillpoint/error.hpp"

namespace stillpoint::importing {
namespace {

[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& reason) {
  throw Error(Fault::kUsage, "cannot be written: " + reason, path.string(),
              "check the folder's permissions and the free space; nothing was imported");
}

std::string stamp_text(double seconds) {
  std::array<char, 64> text{};
  std::snprintf(text.data(), text.size(), "%.6f", seconds);
  return text.data();
}

std::string pose_line(const StampedPose& stamped) {
  const Eigen::Quaterniond q(stamped.world_from_camera.linear());
  const Eigen::Vector3d t = stamped.world_from_camera.translation();
  std::array<char, 512> line{};
  std::snprintf(line.data(), line.size(), "%.6f %.6f %.6f %.6f %.7f %.7f %.7f %.7f\n", stamped.time,
                t.x(), t.y(), t.z(), q.x(), q.y(), q.z(), q.w());
  return line.data();
}

/// "out/room/" is "out/room".
std::filesystem::path without_slash(const std::filesystem::path& folder) {
  return folder.has_filename() ? folder : folder.parent_path();
}

void refuse(const std::filesystem::path& folder, const std::string& what) {
  std::error_code error;  // of a path that cannot be; making it will say why
  if (std::filesystem::exists(folder, error))
    throw Error(Fault::kUsage, what, folder.string(), "name another folder or remove this one");
}

}  // namespace

RecordingFolder::RecordingFolder(const std::filesystem::path& folder)
    : folder_(without_slash(folder)), partial_(folder_.string() + ".partial") {
  refuse(folder_, "is there already");
  refuse(partial_, "is left of an import that did not end, or of one under way");
  std::error_code error;
  for (const char* stream : {"rgb", "depth"}) {
    std::filesystem::create_directories(partial_ / stream, error);
    if (error) fail_to_write(partial_ / stream, error.message());
  }
}

RecordingFolder::~RecordingFolder() { discard(); }

void RecordingFolder::discard() {
  std::error_code ignored;  // after commit() there is nothing to remove
  std::filesystem::remove_all(partial_, ignored);
}

void RecordingFolder::store(const StoredImage& image, const char* stream, std::string& list) {
  const std::string name = std::string(stream) + '/' + stamp_text(image.time) + image.extension;
  const std::filesystem::path target = partial_ / name;
  std::error_code error;
  if (image.file.empty()) {
    errno = 0;
    std::ofstream file(target, std::ios::binary);
    file.write(reinterpret_cast<const char*>(image.bytes.data()),
               static_cast<std::streamsize>(image.bytes.size()));
    file.close();
    if (!file) fail_to_write(target, std::strerror(errno));
    ++written_;
  } else if (std::filesystem::create_hard_link(std::filesystem::canonical(image.file, error),
                                               target, error);
             !error) {
    ++linked_;
  } else {
    std::filesystem::copy_file(image.file, target, error);
    if (error) fail_to_write(target, error.message());
    ++copied_;
  }
  list += stamp_text(image.time) + ' ' + name + '\n';
}

void RecordingFolder::add(const ForeignFrame& frame) {
  if (frame.color) store(*frame.color, "rgb", colors_);
  if (frame.depth) store(*frame.depth, "depth", depths_);
}

void RecordingFolder::write(const std::filesystem::path& name, const std::string& text) const {
  errno = 0;
  std::ofstream file(partial_ / name);
  file << text;
  file.close();
  if (!file) fail_to_write(partial_ / name, std::strerror(errno));
}

void RecordingFolder::commit(std::span<const StampedPose> truth, const std::string& camera_yaml) {
  write("rgb.txt", "# color images\n# timestamp filename\n" + colors_);
  write("depth.txt", "# depth maps\n# timestamp filename\n" + depths_);
  write("camera.yaml", camera_yaml);
  if (!truth.empty()) {
    std::string lines = "# ground truth trajectory\n# timestamp tx ty tz qx qy qz qw\n";
    for (const StampedPose& pose : truth) lines += pose_line(pose);
    write("groundtruth.txt", lines);
  }
  std::error_code error;
  std::filesystem::rename(partial_, folder_, error);
  if (error) fail_to_write(folder_, error.message());
}

bool add_frames(ForeignRecording& recording, RecordingFolder& folder, const std::stop_token& stop,
                const std::function<void(std::size_t frames)>& progress) {
  for (std::size_t i = 0; i < recording.size(); ++i) {
    if (stop.stop_requested()) return false;
    folder.add(recording.read(i));
    progress(i + 1);
  }
  return true;
}

}  // namespace stillpoint::importing
