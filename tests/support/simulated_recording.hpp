// Short simulated recordings on disk, and copies of it in which something is wrong.
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "support/image_io.hpp"
#include "support/program.hpp"

namespace stillpoint::testing {

constexpr const char* kScene = "fr3_walking_xyz_empty";
constexpr const char* kSceneWithPeople = "fr3_walking_xyz";
/// A sanitized program takes many times as long.
inline const int kSimulatedFrames = sanitized_build() ? 30 : 60;

/// Held while the file exists and until the end of the scope; other processes wait.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& file)
      : descriptor_(::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600)) {
    if (descriptor_ < 0 || ::flock(descriptor_, LOCK_EX) != 0)
      throw std::runtime_error("cannot lock " + file.string());
  }
  ~FileLock() { ::close(descriptor_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int descriptor_;
};

/// Rendering takes many times as long under a sanitizer, and gives the same bytes:
/// STILLPOINT_SIMULATOR can name the program of another build.
inline std::filesystem::path simulator_file() {
  const char* other = std::getenv("STILLPOINT_SIMULATOR");
  return other ? std::filesystem::path(other) : program_file();
}

inline std::filesystem::file_time_type newest_of_simulator() {
  auto newest = std::filesystem::last_write_time(simulator_file());
  for (const auto& file : std::filesystem::directory_iterator(
           std::filesystem::path(STILLPOINT_SOURCE_DIR) / "configs/scenes"))
    newest = std::max(newest, file.last_write_time());
  return newest;
}

/// Settings of a scene for images of a quarter of the pixels, where a recording is long.
inline std::vector<std::string> with_small_images(std::vector<std::string> settings) {
  settings.insert(settings.end(), {"camera.width=320", "camera.height=240", "camera.fx=267.7",
                                   "camera.fy=269.6", "camera.cx=159.8", "camera.cy=123.6"});
  return settings;
}

/// What takes a while is made once, since ctest gives each test a process of its own: it stays in
/// the build folder until something that makes it is newer.
inline std::filesystem::path made_once(const std::string& name,
                                       std::filesystem::file_time_type newest,
                                       const std::function<void(std::filesystem::path)>& make) {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(STILLPOINT_BINARY_DIR) / "tests/recordings" / name;
  const fs::path done = folder / "done";
  fs::create_directories(folder.parent_path());
  const FileLock lock(folder.string() + ".lock");
  if (fs::exists(done) && fs::last_write_time(done) > newest) return folder;
  fs::remove_all(folder);
  make(folder);
  std::ofstream(done) << "complete\n";
  return folder;
}

inline std::filesystem::path recording_of(const std::string& scene, int frames = kSimulatedFrames,
                                          const std::vector<std::string>& settings = {}) {
  std::string all = std::to_string(frames);
  for (const std::string& setting : settings) all += ' ' + setting;
  const std::string name = scene + '_' + std::to_string(std::hash<std::string>{}(all));
  return made_once(name, newest_of_simulator(), [&](const std::filesystem::path& folder) {
    std::vector<std::string> arguments = {
        "simulate", scene, "--frames", std::to_string(frames), "-o", folder.string()};
    for (const std::string& setting : settings)
      arguments.insert(arguments.end(), {"--set", setting});
    const Outcome outcome = call(std::move(arguments), {.program = simulator_file()});
    if (outcome.exit_code != 0) throw std::runtime_error("simulate failed: " + outcome.err);
  });
}

inline const std::filesystem::path& simulated_recording() {
  static const std::filesystem::path recording = recording_of(kScene);
  return recording;
}

inline const std::filesystem::path& recording_with_people() {
  static const std::filesystem::path recording = recording_of(kSceneWithPeople);
  return recording;
}

/// The first frames of the simulated recording in a folder of their own, to be changed by a test.
class RecordingCopy {
 public:
  explicit RecordingCopy(int frames) {
    namespace fs = std::filesystem;
    const fs::path& original = simulated_recording();
    for (const char* name : {"camera.yaml", "groundtruth.txt"})
      fs::copy_file(original / name, path() / name);
    colors_ = copy_images(original, "rgb", frames);
    depths_ = copy_images(original, "depth", frames);
  }
  const std::filesystem::path& path() const { return folder_.path(); }
  const std::filesystem::path& color(int frame) const { return colors_.at(frame); }
  const std::filesystem::path& depth(int frame) const { return depths_.at(frame); }

  std::string read(const std::string& name) const { return text_of(path() / name); }
  void write(const std::string& name, const std::string& text) const { folder_.write(name, text); }
  void replace(const std::filesystem::path& image, const cv::Mat& pixels) const {
    write_image(image, pixels);
  }

 private:
  std::vector<std::filesystem::path> copy_images(const std::filesystem::path& original,
                                                 const std::string& stream, int frames) const {
    std::filesystem::create_directories(path() / stream);
    std::ifstream list(original / (stream + ".txt"));
    std::string copied_list;
    std::vector<std::filesystem::path> images;
    for (std::string line; images.size() < static_cast<std::size_t>(frames);) {
      if (!std::getline(list, line)) throw std::runtime_error("the recording is too short");
      copied_list += line + "\n";
      if (line.starts_with("#")) continue;
      const std::string name = line.substr(line.find(' ') + 1);
      std::filesystem::copy_file(original / name, path() / name);
      images.push_back(path() / name);
    }
    write(stream + ".txt", copied_list);
    return images;
  }

  TemporaryFolder folder_;
  std::vector<std::filesystem::path> colors_;
  std::vector<std::filesystem::path> depths_;
};

inline nlohmann::json json_file(const std::filesystem::path& file) {
  return nlohmann::json::parse(text_of(file));
}

/// Lines that are no comments.
inline std::size_t count_poses(const std::filesystem::path& trajectory) {
  std::istringstream stream(text_of(trajectory));
  std::size_t count = 0;
  for (std::string line; std::getline(stream, line);) count += !line.starts_with("#");
  return count;
}

}  // namespace stillpoint::testing
