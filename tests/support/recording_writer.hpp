// Writes small recordings in the format of the TUM RGB-D benchmark into a temporary folder.
#pragma once

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <string>

#include "stillpoint/support/temporary_folder.hpp"
#include "support/image_io.hpp"

namespace stillpoint::testing {

/// A folder of its own under the system's temporary folder, removed at the end.
class TemporaryFolder : public stillpoint::TemporaryFolder {
 public:
  TemporaryFolder() {}  // not defaulted: with clang 14, none could be const then
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    const std::filesystem::path file = path() / name;
    std::filesystem::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary) << text;
    return file;
  }
};

/// A time stamp as the benchmark writes it.
inline std::string stamp_text(double time) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6f", time);
  return text;
}

/// Images go to disk at once; rgb.txt and depth.txt are written by finish() or the destructor.
class RecordingWriter {
 public:
  explicit RecordingWriter(std::filesystem::path folder) : folder_(std::move(folder)) {
    std::filesystem::create_directories(folder_ / "rgb");
    std::filesystem::create_directories(folder_ / "depth");
  }
  ~RecordingWriter() { finish(); }
  RecordingWriter(const RecordingWriter&) = delete;
  RecordingWriter& operator=(const RecordingWriter&) = delete;

  std::filesystem::path color(double time, const cv::Mat& image,
                              const std::string& extension = ".png") {
    return add(time, image, "rgb/" + stamp_text(time) + extension, rgb_list_);
  }
  std::filesystem::path depth(double time, const cv::Mat& image) {
    return add(time, image, "depth/" + stamp_text(time) + ".png", depth_list_);
  }
  void pair(double time, const cv::Mat& color_image, const cv::Mat& depth_image) {
    color(time, color_image);
    depth(time, depth_image);
  }

  void finish() {
    if (finished_) return;
    finished_ = true;
    std::ofstream(folder_ / "rgb.txt") << "# timestamp filename\n" << rgb_list_;
    std::ofstream(folder_ / "depth.txt") << "# timestamp filename\n" << depth_list_;
  }

 private:
  std::filesystem::path add(double time, const cv::Mat& image, const std::string& name,
                            std::string& list) {
    write_image((folder_ / name), image);
    list += stamp_text(time) + " " + name + "\n";
    return folder_ / name;
  }

  std::filesystem::path folder_;
  std::string rgb_list_;
  std::string depth_list_;
  bool finished_ = false;
};

/// Cuts a file to `share` of its size.
inline void truncate_file(const std::filesystem::path& file, double share) {
  const auto size = static_cast<double>(std::filesystem::file_size(file));
  std::filesystem::resize_file(file, static_cast<std::uintmax_t>(size * share));
}

}  // namespace stillpoint::testing
