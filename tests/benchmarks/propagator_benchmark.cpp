// How well and how fast labels are carried to the current frame. Recordings of the simulator with
// their `labels` are searched in the folder that STILLPOINT_RECORDINGS names:
//   stillpoint simulate fr3_walking_xyz -o DIR/fr3_walking_xyz --frames 200
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "propagator_flow_depth/flow_depth_propagator.hpp"
#include "segmenter_label_images/label_image_segmenter.hpp"
#include "source_tum/tum_source.hpp"
#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/runtime/segmentation_stage.hpp"

namespace stillpoint {
namespace {

using propagator_flow_depth::FlowDepthPropagator;
using segmenter_label_images::LabelImageSegmenter;
using source_tum::TumSource;

constexpr int kPerson = 15;
constexpr double kFps = 30;  // of the recordings

struct LabelledRecording {
  std::vector<FramePtr> frames;
  std::vector<cv::Mat> truth;
};

std::filesystem::path recording_folder(const std::string& name) {
  const char* root = std::getenv("STILLPOINT_RECORDINGS");
  return std::filesystem::path(root ? root : ".") / name;
}

const LabelledRecording& recording(const std::string& name) {
  static std::map<std::string, LabelledRecording> cache;
  LabelledRecording& loaded = cache[name];
  if (!loaded.frames.empty()) return loaded;
  const auto folder = recording_folder(name);
  if (!std::filesystem::exists(folder)) return loaded;
  StageContext context{.recording = folder};
  context.camera = load_camera((folder / "camera.yaml").string());
  TumSource source({.path = folder.string(), .selection = {.limit = 200}}, context);
  LabelImageSegmenter truth({.min_object_pixels = 1}, context);
  while (auto frame = source.next()) {
    loaded.truth.push_back(truth.segment(*frame).labels);
    loaded.frames.push_back(std::make_shared<const Frame>(std::move(*frame)));
  }
  return loaded;
}

struct Overlap {
  double both = 0, truth = 0, given = 0;
  double unnoticed = 0;  // of `truth`: persons without any label, mostly those that have just come
  void add(const cv::Mat& a, const cv::Mat& b) {
    const cv::Mat t = a == kPerson, g = b == kPerson;
    both += cv::countNonZero(t & g);
    truth += cv::countNonZero(t);
    given += cv::countNonZero(g);
    cv::Mat persons;
    const int count = cv::connectedComponents(t, persons);
    for (int i = 1; i < count; ++i) {
      const cv::Mat person = persons == i;
      if (cv::countNonZero(person & g) == 0) unnoticed += cv::countNonZero(person);
    }
  }
};

void propagation(benchmark::State& state, const std::string& name, bool propagate) {
  const LabelledRecording& input = recording(name);
  if (input.frames.empty()) return state.SkipWithError("no such recording");
  cv::setNumThreads(1);
  LabelImageSegmenter::Options labels;
  labels.errors.miss_rate = static_cast<double>(state.range(1)) / 100;
  labels.errors.outline_error = static_cast<double>(state.range(2));
  SegmentationOptions schedule{.schedule = SegmentationOptions::Schedule::kLatest,
                               .interval_seconds = 0,
                               .latency_seconds = static_cast<double>(state.range(0)) / kFps};
  Overlap overlap;
  double seconds = 0, longest = 0;
  for (auto _ : state) {
    overlap = {};
    seconds = 0;
    StageContext context{.recording = recording_folder(name)};
    Stage<Propagator> propagator;
    if (propagate)
      propagator = {std::make_shared<FlowDepthPropagator>(FlowDepthPropagator::Options{}),
                    "flow_depth"};
    StopSignal stop;
    TimeLog times;
    SegmentationStage stage(
        {std::make_shared<LabelImageSegmenter>(labels, context), "label_images"},
        std::move(propagator), schedule, RuntimeOptions::Mode::kInline, stop, times);
    for (std::size_t i = 0; i < input.frames.size(); ++i) {
      stage.offer(input.frames[i]);
      const SegmentationPtr carried = stage.labels_for(input.frames[i]);
      for (const StageTime& time : times.take())
        if (time.stage == "propagate") {
          seconds += time.cpu_ms / 1000;
          longest = std::max(longest, time.cpu_ms);
        }
      overlap.add(input.truth[i], carried->labels);
    }
  }
  state.counters["IoU"] = overlap.both / (overlap.truth + overlap.given - overlap.both);
  state.counters["recall"] = overlap.both / overlap.truth;
  state.counters["precision"] = overlap.both / overlap.given;
  state.counters["unnoticed"] = overlap.unnoticed / overlap.truth;
  state.counters["ms"] = 1000 * seconds / static_cast<double>(input.frames.size());
  state.counters["max_ms"] = longest;
}

void cases(benchmark::internal::Benchmark* b) {
  b->Unit(benchmark::kMillisecond)->Iterations(1)->ArgNames({"latency", "miss%", "outline_error"});
  for (const int latency : {0, 1, 3, 6})
    for (const int miss : {0, 10}) b->Args({latency, miss, 0});
  b->Args({3, 10, 2});
}

#define SEQUENCE(name)                                                            \
  BENCHMARK_CAPTURE(propagation, name, "fr3_walking_" #name, true)->Apply(cases); \
  BENCHMARK_CAPTURE(propagation, name##_none, "fr3_walking_" #name, false)->Apply(cases)
SEQUENCE(xyz);
SEQUENCE(rpy);
SEQUENCE(halfsphere);

}  // namespace
}  // namespace stillpoint
