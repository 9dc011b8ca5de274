// Recordings with true poses and a camera.yaml of their own, for programs that measure.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "evaluation/trajectory.hpp"
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/support/rectifier.hpp"

namespace stillpoint {

struct TrueFrame {
  std::shared_ptr<Frame> frame;  // gray and depth
  std::string name;              // of its files in labels/ and instances/
  Pose world_from_camera;
};

/// Every n-th frame of a recording, numbered from 0.
inline std::vector<TrueFrame> read_true_frames(const std::filesystem::path& folder, int every = 1) {
  const auto truth = evaluation::read_trajectory(folder / "groundtruth.txt");
  const Rectifier rectifier(load_camera((folder / "camera.yaml").string()));
  const auto camera = std::make_shared<const Camera>(rectifier.camera());
  std::vector<TrueFrame> frames;
  std::ifstream list(folder / "associations.txt");
  int line_number = 0;
  for (std::string line; std::getline(list, line);) {
    std::istringstream columns(line);
    double time = 0, depth_time = 0;
    std::string color, depth;
    if (!(columns >> time >> color >> depth_time >> depth) || line_number++ % every != 0) continue;
    auto frame = std::make_shared<Frame>();
    frame->index = static_cast<std::uint32_t>(frames.size());
    frame->time = time;
    frame->camera = camera;
    cv::cvtColor(rectifier.color(cv::imread(folder / color)), frame->gray, cv::COLOR_BGR2GRAY);
    frame->depth = rectifier.depth(cv::imread(folder / depth, cv::IMREAD_UNCHANGED));
    frames.push_back({frame, std::filesystem::path(color).filename(), pose_at(truth, time)});
  }
  return frames;
}

/// The recordings in the folder that an environment variable names.
inline std::vector<std::filesystem::path> recordings_in(const char* variable) {
  std::vector<std::filesystem::path> folders;
  if (const char* folder = std::getenv(variable))
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      if (exists(entry.path() / "associations.txt")) folders.push_back(entry.path());
  return folders;
}
inline std::vector<std::filesystem::path> recordings_to_measure() {
  return recordings_in("STILLPOINT_RECORDINGS");
}

}  // namespace stillpoint
