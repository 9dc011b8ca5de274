// Time and quality of the moving checks on simulated recordings, whose truth is known:
//   for s in xyz static rpy halfsphere; do
//     stillpoint simulate fr3_walking_$s -o DIR/walking_$s --frames 200; done
//   STILLPOINT_RECORDINGS=DIR moving_check_benchmark
//
// A followed point truly moves when it lies on a person, a ball or a box in both frames and is, by
// its depth and the true poses, more than 1 px or four standard deviations of depth off the place
// where a static point would be. It stands still when it lies on anything else, or is less than
// half of that off. What is in between, or jumps from one thing to another, does not count.
//
// precision, recall: of `moving` against the truth. false_rate: share of static points called
// moving. reliable: share of frames.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "benchmarks/true_recording.hpp"
#include "moving_checks/lk_checker.hpp"
#include "moving_checks/rgbd_checker.hpp"

namespace stillpoint {
namespace {

using moving_checks::EpipolarChecker;
using moving_checks::LkEpipolar;
using moving_checks::LkHomography;
using moving_checks::LkMagsac;
using moving_checks::LkUsac;
using moving_checks::RgbdChecker;

namespace fs = std::filesystem;

constexpr int kPerson = 15;                            // PASCAL VOC
constexpr double kInverseDepthNoise = 0.0016 * 1.414;  // 1/m, of a difference

struct JudgedFrame {
  Frame frame;
  cv::Mat moves;  // CV_8UC1, instance of what may move by itself, 0 = static world
  Pose world_from_camera;
};

std::vector<JudgedFrame> read_recording(const fs::path& folder) {
  std::vector<JudgedFrame> frames;
  for (const TrueFrame& read : read_true_frames(folder)) {
    const cv::Mat labels = cv::imread(folder / "labels" / read.name, cv::IMREAD_UNCHANGED);
    cv::Mat moves = cv::imread(folder / "instances" / read.name, cv::IMREAD_UNCHANGED);
    moves.setTo(0, (labels != kPerson) & (labels != 0));
    frames.push_back({*read.frame, moves, read.world_from_camera});
  }
  return frames;
}

// The benchmarks of one recording follow each other.
const std::vector<JudgedFrame>& recording(const fs::path& folder) {
  static fs::path loaded;
  static std::vector<JudgedFrame> frames;
  if (loaded != folder) frames = read_recording(loaded = folder);
  return frames;
}

enum class Truth { kMoves, kStatic, kUnclear };

float depth_at(const Frame& frame, const cv::Point2f& p) {
  return frame.depth.at<float>(cvRound(p.y), cvRound(p.x));
}

Truth truth_of(const PointMotion& point, const JudgedFrame& previous, const JudgedFrame& current) {
  const int from =
      previous.moves.at<std::uint8_t>(cvRound(point.previous.y), cvRound(point.previous.x));
  const int to = current.moves.at<std::uint8_t>(cvRound(point.current.y), cvRound(point.current.x));
  if (from != to) return Truth::kUnclear;
  if (from == 0) return Truth::kStatic;
  const float z_from = depth_at(previous.frame, point.previous);
  const float z_to = depth_at(current.frame, point.current);
  if (z_from <= 0 || z_to <= 0) return Truth::kUnclear;
  const Camera& camera = *current.frame.camera;
  const Eigen::Vector3d p = current.world_from_camera.inverse() * previous.world_from_camera *
                            camera.unproject(point.previous.x, point.previous.y, z_from);
  const double pixels =
      (camera.project(p) - Eigen::Vector2d(point.current.x, point.current.y)).norm();
  const double depths = std::abs(1 / p.z() - 1 / z_to) / kInverseDepthNoise;
  const double off = std::max(pixels, depths / 4);
  return off > 1 ? Truth::kMoves : off < 0.5 ? Truth::kStatic : Truth::kUnclear;
}

struct Counts {
  double found = 0, missed = 0, wrong = 0, right = 0;
  double frames = 0, reliable = 0, points = 0;

  void add(const MovingPoints& result, const JudgedFrame& previous, const JudgedFrame& current) {
    ++frames;
    reliable += result.reliable;
    points += static_cast<double>(result.points.size());
    for (const PointMotion& point : result.points) {
      const Truth truth = truth_of(point, previous, current);
      const bool called = result.reliable && point.moving;
      found += called && truth == Truth::kMoves;
      missed += !called && truth == Truth::kMoves;
      wrong += called && truth == Truth::kStatic;
      right += !called && truth == Truth::kStatic;
    }
  }

  void report(benchmark::State& state) const {
    state.counters["precision"] = found / std::max(1.0, found + wrong);
    state.counters["recall"] = found / std::max(1.0, found + missed);
    state.counters["false_rate"] = wrong / std::max(1.0, wrong + right);
    state.counters["reliable"] = reliable / frames;
    state.counters["points"] = points / frames;
  }
};

template <class Checker>
std::unique_ptr<MovingChecker> make(const typename Checker::Options& options) {
  if constexpr (std::is_constructible_v<Checker, typename Checker::Options, StageContext>)
    return std::make_unique<Checker>(options, StageContext{});
  else
    return std::make_unique<Checker>(options);
}

template <class Checker>
void check(benchmark::State& state, const fs::path& folder, std::size_t stride,
           const typename Checker::Options& options) {
  cv::setNumThreads(1);
  const std::vector<JudgedFrame>& frames = recording(folder);
  const auto checker = make<Checker>(options);
  Counts counts;
  std::size_t i = stride;
  for ([[maybe_unused]] auto _ : state) {
    const MovingPoints result = checker->check(frames.at(i - stride).frame, frames.at(i).frame, {});
    state.PauseTiming();
    counts.add(result, frames[i - stride], frames[i]);
    i = i + stride < frames.size() ? i + stride : stride;
    state.ResumeTiming();
  }
  counts.report(state);
}

template <class Checker>
void add(const std::string& name, const fs::path& folder, std::size_t stride,
         const typename Checker::Options& options = {}) {
  const std::string title =
      folder.filename().string() + "/" + name + "/every_" + std::to_string(stride);
  const auto files = std::distance(fs::directory_iterator(folder / "instances"), {});
  benchmark::RegisterBenchmark(
      title.c_str(),
      [=](benchmark::State& state) { check<Checker>(state, folder, stride, options); })
      ->Unit(benchmark::kMillisecond)
      ->Iterations((files - 1) / static_cast<long>(stride));
}

const bool kRegistered = [] {
  for (const fs::path& folder : recordings_to_measure()) {
    if (!fs::exists(folder / "instances")) continue;
    for (const std::size_t stride : {1, 3}) {
      LkEpipolar::Options released;
      released.lk.consensus.ransac_threshold = 0.1;
      released.lk.follow = {.corners = {.corners = moving_checks::CornerOptions::Method::kShiTomasi,
                                        .max_corners = 1000,
                                        .corner_quality = 0.01},
                            .window = 22,
                            .pyramid_levels = 6,
                            .iterations = 20,
                            .accuracy = 0.01,
                            .max_patch_difference = 2120};
      released.when_degenerate = EpipolarChecker::Degenerate::kIgnore;
      released.lk.min_inlier_share = 0;
      add<LkEpipolar>("lk_epipolar", folder, stride);
      add<LkEpipolar>("lk_epipolar_ignore", folder, stride,
                      {.when_degenerate = EpipolarChecker::Degenerate::kIgnore});
      add<LkEpipolar>("lk_epipolar_homography", folder, stride,
                      {.when_degenerate = EpipolarChecker::Degenerate::kHomography});
      add<LkEpipolar>("lk_epipolar_released", folder, stride, released);
      add<LkUsac>("lk_usac", folder, stride);
      add<LkMagsac>("lk_magsac", folder, stride);
      add<LkHomography>("lk_homography", folder, stride);
      add<RgbdChecker>("rgbd_reprojection", folder, stride);
    }
  }
  return true;
}();

}  // namespace
}  // namespace stillpoint
