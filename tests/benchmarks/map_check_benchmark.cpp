// Time and quality of the map check on recordings whose poses and people are known: simulated ones,
// or those of tools/real_people.
//   stillpoint simulate fr3_walking_xyz -o DIR/walking_xyz --frames 200
//   STILLPOINT_RECORDINGS=DIR map_check_benchmark
//
// The check gets the true pose of the frame before, and weights that leave out people; of cells
// with depth, by the labels: people_in: share on people that is called come in; false_in: the same
// of all else; standing: share of all else that is called standing. Both are of frames after the
// first second.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "benchmarks/true_recording.hpp"
#include "map_checks/depth_consistency.hpp"

namespace stillpoint {
namespace {

using map_checks::DepthConsistency;

namespace fs = std::filesystem;

constexpr int kPerson = 15;  // PASCAL VOC
constexpr std::size_t kFrames = 300;

struct LabelledFrame {
  TrueFrame frame;
  cv::Mat people;  // CV_8UC1, 255 on them
};

std::vector<LabelledFrame> read_recording(const fs::path& folder) {
  std::vector<LabelledFrame> frames;
  for (TrueFrame& frame : read_true_frames(folder)) {
    if (frames.size() == kFrames) break;
    const cv::Mat labels = cv::imread(folder / "labels" / frame.name, cv::IMREAD_UNCHANGED);
    frames.push_back({std::move(frame), labels == kPerson});
  }
  return frames;
}

struct Shares {
  double people = 0, people_in = 0, rest = 0, false_in = 0, standing = 0;

  void add(const MapEvidence& evidence, const LabelledFrame& seen) {
    if (evidence.log_odds.empty()) return;
    const cv::Size cells = evidence.log_odds.size();
    cv::Mat on_people, depth;
    cv::resize(seen.people, on_people, cells, 0, 0, cv::INTER_NEAREST);
    cv::resize(seen.frame.frame->depth, depth, cells, 0, 0, cv::INTER_NEAREST);
    const cv::Mat known = depth > 0, in = evidence.log_odds > 0, same = evidence.log_odds < 0;
    people += cv::countNonZero(on_people & known);
    people_in += cv::countNonZero(on_people & known & in);
    rest += cv::countNonZero(~on_people & known);
    false_in += cv::countNonZero(~on_people & known & in);
    standing += cv::countNonZero(~on_people & known & same);
  }

  void report(benchmark::State& state) const {
    state.counters["people_in"] = people_in / std::max(1.0, people);
    state.counters["false_in"] = false_in / std::max(1.0, rest);
    state.counters["standing"] = standing / std::max(1.0, rest);
  }
};

void check_recording(benchmark::State& state, const fs::path& folder) {
  cv::setNumThreads(1);
  const std::vector<LabelledFrame> frames = read_recording(folder);
  const SparseMap map;
  for ([[maybe_unused]] auto _ : state) {
    DepthConsistency checker({});
    Shares shares;
    for (std::size_t i = 0; i < frames.size(); ++i) {
      const TrueFrame& now = frames[i].frame;
      const Pose guess = frames[i > 0 ? i - 1 : 0].frame.world_from_camera;
      const MapEvidence evidence = checker.check(*now.frame, {&guess, 1}, map);
      const auto weights = std::make_shared<StaticWeights>();
      weights->track = weights->map = ~frames[i].people;
      checker.remember(
          {.frame = now.frame, .weights = weights, .world_from_camera = now.world_from_camera});
      state.PauseTiming();
      if (now.frame->time - frames.front().frame.frame->time > 1) shares.add(evidence, frames[i]);
      state.ResumeTiming();
    }
    shares.report(state);
  }
  state.counters["seconds_per_frame"] = benchmark::Counter(
      static_cast<double>(frames.size()),
      benchmark::Counter::kIsIterationInvariantRate | benchmark::Counter::kInvert);
}

const bool kRegistered = [] {
  for (const fs::path& folder : recordings_to_measure())
    benchmark::RegisterBenchmark(folder.filename().c_str(),
                                 [=](benchmark::State& state) { check_recording(state, folder); })
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  return true;
}();

}  // namespace
}  // namespace stillpoint
