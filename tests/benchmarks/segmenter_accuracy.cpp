// How much of the people the shipped network sees, as configs/segmenters/selfie.yaml uses it, by
// the share of the picture that they fill.
//   segmenter_accuracy RECORDING...
// Recordings of the simulator with their `labels`; every fifth frame.
#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>
#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "segmenter_opencv_dnn/opencv_dnn_segmenter.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

constexpr int kEvery = 5;
constexpr int kTruePerson = 15;  // VOC
constexpr int kPerson = 1;       // of the network, which knows nothing else
constexpr std::array<double, 5> kShares = {0.0, 0.1, 0.2, 0.35, 1.0};

struct Overlap {
  int frames = 0;
  int unseen_frames = 0;  // with less than half of the people's pixels
  double both = 0, truth = 0, given = 0;

  void add(const cv::Mat& true_person, const cv::Mat& person) {
    const int here = cv::countNonZero(true_person);
    const int found = cv::countNonZero(true_person & person);
    ++frames;
    unseen_frames += 2 * found < here;
    both += found;
    truth += here;
    given += cv::countNonZero(person);
  }
};

OpenCvDnnSegmenter shipped_network() {
  OpenCvDnnSegmenter::Options options;
  options.network.model = fs::path(STILLPOINT_SOURCE_DIR) / "plugins/segmenter_opencv_dnn/models" /
                          options.network.model;
  options.rule.threshold = 0.45;
  options.refinement.radius = 8;
  return OpenCvDnnSegmenter(options, {});
}

std::vector<fs::path> images_in(const fs::path& recording) {
  std::vector<fs::path> images;
  for (const auto& entry : fs::directory_iterator(recording / "rgb")) images.push_back(entry);
  std::sort(images.begin(), images.end());
  return images;
}

void measure(const fs::path& recording) {
  OpenCvDnnSegmenter network = shipped_network();
  std::array<Overlap, kShares.size() - 1> bins;
  const std::vector<fs::path> images = images_in(recording);
  for (std::size_t i = 0; i < images.size(); i += kEvery) {
    const cv::Mat truth =
        cv::imread(recording / "labels" / images[i].filename(), cv::IMREAD_UNCHANGED);
    const cv::Mat true_person = truth == kTruePerson;
    const int pixels = cv::countNonZero(true_person);
    if (pixels == 0) continue;
    const double share = pixels / static_cast<double>(truth.total());
    const auto bin = std::lower_bound(kShares.begin() + 1, kShares.end(), share);
    Frame frame{.index = static_cast<std::uint32_t>(i), .bgr = cv::imread(images[i])};
    cv::cvtColor(frame.bgr, frame.gray, cv::COLOR_BGR2GRAY);
    bins[static_cast<std::size_t>(bin - kShares.begin()) - 1].add(
        true_person, network.segment(frame).labels == kPerson);
  }
  std::printf("%s\n%12s %8s %8s %10s %12s\n", recording.filename().c_str(), "people fill", "frames",
              "recall", "precision", "half unseen");
  for (std::size_t b = 0; b < bins.size(); ++b) {
    if (bins[b].frames == 0) continue;
    std::printf("%3.0f to %3.0f %% %8d %8.2f %10.2f %12d\n", 100 * kShares[b], 100 * kShares[b + 1],
                bins[b].frames, bins[b].both / bins[b].truth,
                bins[b].both / std::max(1.0, bins[b].given), bins[b].unseen_frames);
  }
}

}  // namespace
}  // namespace stillpoint

int main(int count, char** arguments) {
  if (count < 2) {
    std::cerr << "usage: segmenter_accuracy RECORDING...\n";
    return 2;
  }
  for (int i = 1; i < count; ++i) stillpoint::measure(arguments[i]);
}
