// Time of one image through SegNets of the published layouts, with random weights. The argument is
// the number of threads.
#include <benchmark/benchmark.h>

#include "segmenter_segnet/segnet_segmenter.hpp"
#include "segmenter_segnet/test_network.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint {
namespace {

using segmenter_segnet::SegnetSegmenter;

using segmenter_segnet::TestNetwork;

void segment(benchmark::State& state, const TestNetwork& network) {
  const testing::TemporaryFolder folder;
  SegnetSegmenter::Options options;
  options.prototxt = folder.write("net.prototxt", network.prototxt()).string();
  options.model = folder.write("net.caffemodel", network.caffemodel()).string();
  options.classes.assign(static_cast<std::size_t>(network.channels()), "class");
  SegnetSegmenter segmenter(options, {.threads = static_cast<int>(state.range(0))});
  Frame frame{.bgr = cv::Mat(480, 640, CV_8UC3)};
  cv::RNG random(1);
  random.fill(frame.bgr, cv::RNG::UNIFORM, 0, 256);
  benchmark::DoNotOptimize(segmenter.segment(frame));  // the first one allocates
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(segmenter.segment(frame));
}

void segnet_basic(benchmark::State& state) {
  segment(state, segmenter_segnet::segnet_basic(360, 480, 64, 11, 1));
}
void segnet_vgg16(benchmark::State& state) {
  segment(state, segmenter_segnet::segnet_vgg16(360, 480, 1, 21, 1));
}
void segnet_vgg16_small_input(benchmark::State& state) {
  segment(state, segmenter_segnet::segnet_vgg16(224, 224, 1, 21, 1));
}
void load_segnet_vgg16(benchmark::State& state) {
  const TestNetwork network = segmenter_segnet::segnet_vgg16(224, 224, 1, 21, 1);
  const testing::TemporaryFolder folder;
  const auto prototxt = folder.write("net.prototxt", network.prototxt());
  const auto model = folder.write("net.caffemodel", network.caffemodel());
  for ([[maybe_unused]] auto _ : state) segmenter_segnet::SegnetNetwork(prototxt, model);
}
BENCHMARK(segnet_basic)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(segnet_vgg16)->Arg(1)->Arg(2)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime();
BENCHMARK(segnet_vgg16_small_input)
    ->Arg(1)
    ->Arg(2)
    ->Unit(benchmark::kMillisecond)
    ->MeasureProcessCPUTime();
BENCHMARK(load_segnet_vgg16)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillpoint
