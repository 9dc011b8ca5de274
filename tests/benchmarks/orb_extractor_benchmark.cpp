// Time of one image's features: of a real one where the shared recordings are, else of boxes.
#include <benchmark/benchmark.h>

#include <opencv2/core/utility.hpp>
#include <opencv2/features2d.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "orb_slam/orb_extractor.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr char kRecordedImage[] =
    STILLPOINT_SOURCE_DIR "/../shared/data/tum_fr3_walking_halfsphere_rgb/1341846434.710184.png";

cv::Mat boxes() {
  cv::Mat image(480, 640, CV_8UC1, cv::Scalar(128));
  cv::RNG random(5);
  for (int i = 0; i < 700; ++i) {
    const cv::Point corner(random.uniform(0, 640), random.uniform(0, 480));
    const cv::Size size(random.uniform(6, 70), random.uniform(6, 70));
    cv::rectangle(image, cv::Rect(corner, size), cv::Scalar(random.uniform(20, 236)), cv::FILLED);
  }
  cv::GaussianBlur(image, image, {}, 0.8);
  return image;
}

cv::Mat benchmark_image() {
  const cv::Mat image = cv::imread(kRecordedImage, cv::IMREAD_GRAYSCALE);
  return image.empty() ? boxes() : image;
}

void extract(benchmark::State& state, const OrbOptions& options) {
  cv::setNumThreads(1);
  const cv::Mat image = benchmark_image();
  OrbExtractor extractor(options);
  std::size_t features = 0;
  for ([[maybe_unused]] auto _ : state) features = extractor.extract(image).size();
  state.counters["features"] = static_cast<double>(features);
}
BENCHMARK_CAPTURE(extract, default, OrbOptions{})->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(extract, whole_pixels, OrbOptions{.subpixel = false})
    ->Unit(benchmark::kMillisecond);

void extract_by_opencv(benchmark::State& state) {
  cv::setNumThreads(1);
  const cv::Mat image = benchmark_image();
  const auto orb = cv::ORB::create(1000);
  std::vector<cv::KeyPoint> keypoints;
  cv::Mat descriptors;
  for ([[maybe_unused]] auto _ : state)
    orb->detectAndCompute(image, cv::noArray(), keypoints, descriptors);
  state.counters["features"] = static_cast<double>(keypoints.size());
}
BENCHMARK(extract_by_opencv)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillpoint::orb_slam
