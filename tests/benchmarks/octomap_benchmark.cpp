// Integration of key frames into the octree, beside OctoMap's own: every thirtieth frame of the
// recordings in the folder STILLPOINT_RECORDINGS, all pixels, 4 m. And the correction after a loop:
// a hundred key frames that have all moved.
#include <benchmark/benchmark.h>
#include <octomap/ColorOcTree.h>

#include <algorithm>
#include <filesystem>
#include <string>

#include "benchmarks/true_recording.hpp"
#include "map_octomap/octomap_backend.hpp"

namespace stillpoint {
namespace {

using map_octomap::OctomapBackend;
using semantic_octree::ScanBricks;
using semantic_octree::SemanticOctree;

constexpr double kRange = 4.0;  // metres
constexpr int kEvery = 30;

std::vector<DenseKeyFrame> keyframes_of(const std::filesystem::path& folder, int every = kEvery) {
  std::vector<DenseKeyFrame> keyframes;
  for (const TrueFrame& seen : read_true_frames(folder, every)) {
    auto frame = std::make_shared<Frame>(*seen.frame);
    cv::cvtColor(frame->gray, frame->bgr, cv::COLOR_GRAY2BGR);
    keyframes.push_back(
        {.id = frame->index, .frame = frame, .world_from_camera = seen.world_from_camera});
  }
  return keyframes;
}

void ours(benchmark::State& state, const std::filesystem::path& folder, double resolution,
          double sigmas_before_surface) {
  const auto keyframes = keyframes_of(folder);
  std::size_t nodes = 0, bytes = 0;
  for (auto _ : state) {
    SemanticOctree tree(resolution);
    ScanBricks scan({.resolution = resolution,
                     .range = kRange,
                     .sigmas_before_surface = sigmas_before_surface});
    for (const DenseKeyFrame& keyframe : keyframes) {
      scan.scan(keyframe);
      tree.add(scan, scan.bricks(), {});
    }
    state.PauseTiming();
    nodes = tree.size();
    bytes = tree.memoryUsage();
    tree.clear();
    state.ResumeTiming();
  }
  state.counters["per_keyframe"] = benchmark::Counter(
      static_cast<double>(keyframes.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
  state.counters["nodes"] = static_cast<double>(nodes);
  state.counters["MiB"] = static_cast<double>(bytes) / (1 << 20);
}

// What OctoMap does.
void ours_plain(benchmark::State& state, const std::filesystem::path& folder, double resolution) {
  ours(state, folder, resolution, 0.0);
}

// What the back end does.
void ours_as_used(benchmark::State& state, const std::filesystem::path& folder, double resolution) {
  ours(state, folder, resolution, OctomapBackend::kSigmasBeforeSurface);
}

void scans_only(benchmark::State& state, const std::filesystem::path& folder, double resolution) {
  const auto keyframes = keyframes_of(folder);
  ScanBricks scan({.resolution = resolution, .range = kRange});
  for (auto _ : state)
    for (const DenseKeyFrame& keyframe : keyframes) scan.scan(keyframe);
  state.counters["per_keyframe"] = benchmark::Counter(
      static_cast<double>(keyframes.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

void octomaps(benchmark::State& state, const std::filesystem::path& folder, double resolution) {
  struct Cloud {
    octomap::Pointcloud points;
    octomap::point3d eye;
  };
  std::vector<Cloud> clouds;
  for (const DenseKeyFrame& keyframe : keyframes_of(folder)) {
    Cloud& cloud = clouds.emplace_back();
    const Pose& pose = keyframe.world_from_camera;
    const Eigen::Vector3f eye = pose.translation().cast<float>();
    cloud.eye = {eye.x(), eye.y(), eye.z()};
    const cv::Mat& depth = keyframe.frame->depth;
    for (int v = 0; v < depth.rows; ++v)
      for (int u = 0; u < depth.cols; ++u) {
        const float z = depth.at<float>(v, u);
        if (z <= 0) continue;
        const Eigen::Vector3f p = (pose * keyframe.frame->camera->unproject(u, v, z)).cast<float>();
        cloud.points.push_back(p.x(), p.y(), p.z());
      }
  }
  for (auto _ : state) {
    octomap::ColorOcTree tree(resolution);
    for (const Cloud& cloud : clouds)
      tree.insertPointCloud(cloud.points, cloud.eye, kRange, false, true);
    state.PauseTiming();
    tree.clear();
    state.ResumeTiming();
  }
  state.counters["per_keyframe"] = benchmark::Counter(
      static_cast<double>(clouds.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

// As the back end does it, with the pixels that it keeps.
void correction(benchmark::State& state, const std::filesystem::path& folder, double resolution) {
  constexpr std::size_t kKeyFrames = 100;
  std::vector<DenseKeyFrame> keyframes = keyframes_of(folder, 7);
  keyframes.resize(std::min(keyframes.size(), kKeyFrames));
  OctomapBackend map({.resolution = resolution, .range = kRange}, StageContext{});
  for (const DenseKeyFrame& keyframe : keyframes) map.integrate(keyframe);
  double side = 1;
  for (auto _ : state) {
    std::vector<MovedKeyFrame> moved;
    for (const DenseKeyFrame& keyframe : keyframes) {
      Pose pose = keyframe.world_from_camera;
      pose.translation().x() += side * 0.001 * keyframe.id;
      moved.push_back({keyframe.id, pose});
    }
    map.move(moved);
    side = -side;
  }
  state.counters["keyframes"] = static_cast<double>(keyframes.size());
}

[[maybe_unused]] const bool kRegistered = [] {
  for (const auto& folder : recordings_to_measure())
    for (const double resolution : {0.05, 0.02}) {
      const std::string name =
          folder.filename().string() + "/" + std::to_string(std::lround(100 * resolution)) + "cm/";
      const auto add = [&](const std::string& what, auto* function) {
        benchmark::RegisterBenchmark((name + what).c_str(), [=](benchmark::State& state) {
          function(state, folder, resolution);
        })->Unit(benchmark::kMillisecond);
      };
      add("scan", scans_only);
      add("ours", ours_plain);
      add("ours_as_used", ours_as_used);
      add("octomap", octomaps);
      add("correction", correction);
    }
  return true;
}();

}  // namespace
}  // namespace stillpoint
