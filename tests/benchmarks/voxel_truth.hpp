// What is where in a simulated recording, voxel by voxel, for programs that judge dense maps.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <iostream>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

#include "benchmarks/true_recording.hpp"

namespace stillpoint {

inline constexpr double kRange = 4.0;  // metres
inline constexpr std::uint8_t kPerson = 15;

using Key = std::array<int, 3>;
struct KeyHash {
  std::size_t operator()(const Key& k) const {
    return static_cast<std::size_t>(k[0]) * 73856093U ^ static_cast<std::size_t>(k[1]) * 19349663U ^
           static_cast<std::size_t>(k[2]) * 83492791U;
  }
};

/// What is where, in the frame of the map that is judged: of what stands still, pixels by class;
/// and what people have been in.
struct Truth {
  std::unordered_map<Key, std::map<std::uint8_t, int>, KeyHash> still;
  std::unordered_map<Key, int, KeyHash> people;
  double seconds = 0;
};

struct LabelledFrame {
  TrueFrame seen;
  cv::Mat labels, instances;  // of the second, 0 is the room
};

inline Key key_of(const Eigen::Vector3d& point, double edge) {
  return {static_cast<int>(std::floor(point.x() / edge)),
          static_cast<int>(std::floor(point.y() / edge)),
          static_cast<int>(std::floor(point.z() / edge))};
}

template <class Map>
const typename Map::value_type* near(const Map& voxels, const Key& key) {
  if (const auto same = voxels.find(key); same != voxels.end()) return &*same;
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (const auto found = voxels.find({key[0] + x, key[1] + y, key[2] + z});
            found != voxels.end())
          return &*found;
  return nullptr;
}

inline std::vector<LabelledFrame> read_labelled_frames(const std::filesystem::path& folder,
                                                       int every) {
  std::vector<LabelledFrame> frames;
  for (TrueFrame& seen : read_true_frames(folder, every)) {
    cv::Mat labels = cv::imread(folder / "labels" / seen.name, cv::IMREAD_UNCHANGED);
    cv::Mat instances = cv::imread(folder / "instances" / seen.name, cv::IMREAD_UNCHANGED);
    if (labels.empty() || instances.empty())
      throw std::runtime_error(folder.string() + " has no labels or instances");
    frames.push_back({std::move(seen), std::move(labels), std::move(instances)});
  }
  if (frames.empty()) throw std::runtime_error(folder.string() + " has no frames");
  return frames;
}

inline Truth truth_in(const std::vector<LabelledFrame>& frames, const Pose& map_from_truth,
                      double edge) {
  Truth truth;
  truth.seconds = frames.back().seen.frame->time - frames.front().seen.frame->time;
  for (const auto& [seen, labels, instances] : frames) {
    const Pose map_from_camera = map_from_truth * seen.world_from_camera;
    const cv::Mat& depth = seen.frame->depth;
    for (int v = 0; v < depth.rows; ++v)
      for (int u = 0; u < depth.cols; ++u) {
        const Eigen::Vector3d point = seen.frame->camera->unproject(u, v, depth.at<float>(v, u));
        if (point.z() <= 0 || point.norm() > kRange) continue;
        const Key key = key_of(map_from_camera * point, edge);
        const std::uint8_t label = labels.at<std::uint8_t>(v, u);
        if (label == kPerson)
          ++truth.people[key];
        else
          ++truth.still[key][label];
      }
  }
  return truth;
}

/// Things that the last quarter of the frames shows, as a box that was put down, stand there.
inline void add_things(const std::vector<LabelledFrame>& frames, const Pose& map_from_truth,
                       double edge, Truth& truth) {
  std::vector<LabelledFrame> last(frames.end() - static_cast<std::ptrdiff_t>(frames.size() / 4),
                                  frames.end());
  for (LabelledFrame& frame : last) {
    frame.seen.frame = std::make_shared<Frame>(*frame.seen.frame);
    cv::Mat& depth = frame.seen.frame->depth;
    depth = depth.clone();
    depth.setTo(0, frame.instances == 0);
  }
  for (const auto& [key, counts] : truth_in(last, map_from_truth, edge).still)
    for (const auto& [label, pixels] : counts) truth.still[key][label] += pixels;
}

inline std::uint8_t most_seen(const std::map<std::uint8_t, int>& counts) {
  return std::ranges::max_element(counts, {}, [](const auto& c) { return c.second; })->first;
}

/// What a program's main() does that judges folders against the truth in the first of them.
inline int run_on_folders(int argc, char** argv, const char* usage,
                          void (*run)(const std::vector<std::filesystem::path>&)) {
  if (argc < 3) {
    std::cerr << usage << '\n';
    return 2;
  }
  try {
    run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    std::cerr << "error: " << error.what() << '\n';
    return 1;
  }
  return 0;
}

}  // namespace stillpoint
