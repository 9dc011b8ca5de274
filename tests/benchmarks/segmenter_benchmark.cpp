// Time of the shipped network on one 640 x 480 image, with everything before and after it: of a
// real image where the shared recordings are, else of noise.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "segmenter_opencv_dnn/opencv_dnn_segmenter.hpp"

namespace stillpoint {
namespace {

using segmenter_opencv_dnn::CellAlignment;
using segmenter_opencv_dnn::Network;
using segmenter_opencv_dnn::OpenCvDnnSegmenter;
using segmenter_opencv_dnn::ResultKind;

constexpr char kModels[] = STILLPOINT_SOURCE_DIR "/plugins/segmenter_opencv_dnn/models/";
constexpr char kSharedModels[] = STILLPOINT_SOURCE_DIR "/../shared/models/";
constexpr char kRecordedImage[] =
    STILLPOINT_SOURCE_DIR "/../shared/data/tum_fr3_walking_halfsphere_rgb/1341846434.710184.png";

Frame benchmark_frame() {
  Frame frame;
  frame.bgr = cv::imread(kRecordedImage);
  if (frame.bgr.empty()) {
    frame.bgr = cv::Mat(480, 640, CV_8UC3);
    cv::RNG(5).fill(frame.bgr, cv::RNG::UNIFORM, 0, 256);
  }
  cv::cvtColor(frame.bgr, frame.gray, cv::COLOR_BGR2GRAY);
  return frame;
}

OpenCvDnnSegmenter::Options shipped() {
  OpenCvDnnSegmenter::Options options;
  options.network.model = kModels + options.network.model;
  return options;
}

OpenCvDnnSegmenter::Options refined() {
  OpenCvDnnSegmenter::Options options = shipped();
  options.refinement.radius = 8;
  return options;
}

/// As configs/segmenters/person.yaml has it.
OpenCvDnnSegmenter::Options person() {
  OpenCvDnnSegmenter::Options options;
  options.network = {.model = std::string(kModels) + "person_320x256.onnx",
                     .width = 320,
                     .height = 256,
                     .scale = {1.0 / 128},
                     .mean = {128}};
  options.rule.result = ResultKind::kLogit;
  return options;
}

OpenCvDnnSegmenter::Options deeplab() {
  OpenCvDnnSegmenter::Options options;
  options.network = {.model = std::string(kSharedModels) + "deeplabv3_mnv2_voc21.onnx",
                     .width = 513,
                     .height = 385,
                     .scale = {1.0 / 128},
                     .mean = {128}};
  options.rule.result = ResultKind::kClassLogits;
  options.cells = CellAlignment::kCorners;
  options.classes = {"voc21"};
  return options;
}

/// The argument is the number of OpenCV's threads.
void segment(benchmark::State& state, OpenCvDnnSegmenter::Options options) {
  if (!std::filesystem::exists(options.network.model)) {
    state.SkipWithError("the network is not there");
    return;
  }
  options.threads = static_cast<int>(state.range(0));
  OpenCvDnnSegmenter segmenter(options, {});
  const Frame frame = benchmark_frame();
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(segmenter.segment(frame));
  state.counters["threads"] = options.threads;
}
BENCHMARK_CAPTURE(segment, shipped, shipped())
    ->Arg(1)
    ->Arg(2)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(segment, refined, refined())
    ->Arg(1)
    ->Arg(2)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(segment, person, person())
    ->Arg(1)
    ->Arg(2)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(segment, deeplab_voc21, deeplab())
    ->Arg(2)
    ->MeasureProcessCPUTime()
    ->UseRealTime()
    ->Unit(benchmark::kMillisecond);

/// The network and the making of its input alone.
void network(benchmark::State& state) {
  cv::setNumThreads(static_cast<int>(state.range(0)));
  Network net(shipped().network, false);
  const Frame frame = benchmark_frame();
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(net.run(frame.bgr));
}
BENCHMARK(network)->Arg(1)->Arg(2)->MeasureProcessCPUTime()->UseRealTime()->Unit(
    benchmark::kMillisecond);

}  // namespace
}  // namespace stillpoint
