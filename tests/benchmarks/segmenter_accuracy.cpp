// How much of the people a segmenter sees, by the share of the picture that they fill, and what it
// takes for people.
//   segmenter_accuracy [KEY=VALUE]... RECORDING...
// The segmenter is that of the pipeline `stillpoint`, or another (`segmenter=selfie`). Recordings
// with `labels`, of the simulator or with real people; every fifth frame.
#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "stillpoint/contracts/segmenter.hpp"
#include "stillpoint/contracts/source.hpp"
#include "stillpoint/engine/pipeline_config.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

constexpr int kEvery = 5;
constexpr double kMuch = 0.03;  // of the picture, called a person where nobody is
constexpr int kNear = 10;       // pixels around people, where an outline may be off
constexpr std::array<double, 6> kShares = {-1.0, 0.0, 0.1, 0.2, 0.35, 1.0};

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

/// Of pixels called a person away from people.
struct Mistaken {
  double shares = 0, largest = 0;
  int frames = 0, frames_with_much = 0;

  void add(const cv::Mat& true_person, const cv::Mat& person) {
    cv::Mat near;
    cv::dilate(true_person, near, cv::Mat::ones(2 * kNear + 1, 2 * kNear + 1, CV_8U));
    const double share =
        cv::countNonZero(person & ~near) / static_cast<double>(true_person.total());
    shares += share;
    largest = std::max(largest, share);
    ++frames;
    frames_with_much += share > kMuch;
  }
};

struct Recording {
  Registry registry;
  std::shared_ptr<Source> source;
  std::shared_ptr<Segmenter> segmenter, truth;

  Recording(const fs::path& folder, std::vector<std::string> assignments) {
    PipelineRequest request;
    request.pipeline = "stillpoint";
    request.dataset = folder;
    request.assignments = std::move(assignments);
    const PipelineConfig config = load_pipeline(request, registry);
    request.assignments = {"segmenter.type=label_images"};
    const PipelineConfig true_labels = load_pipeline(request, registry);
    StageContext context;
    context.recording = config.recording;
    context.camera = config.camera;
    source = config.source->create<Source>(context);
    segmenter = config.segmenter->create<Segmenter>(context);
    truth = true_labels.segmenter->create<Segmenter>(context);
  }
};

cv::Mat people(Segmenter& segmenter, const Frame& frame) {
  return segmenter.segment(frame).labels == class_id(segmenter.classes(), "person");
}

void measure(const fs::path& folder, const std::vector<std::string>& assignments) {
  Recording recording(folder, assignments);
  std::array<Overlap, kShares.size() - 1> bins;
  Mistaken mistaken;
  while (const std::optional<Frame> frame = recording.source->next()) {
    if (frame->index % kEvery != 0) continue;
    const cv::Mat truth = people(*recording.truth, *frame);
    const cv::Mat found = people(*recording.segmenter, *frame);
    const double share = cv::countNonZero(truth) / static_cast<double>(truth.total());
    const auto bin = std::lower_bound(kShares.begin() + 1, kShares.end(), share);
    bins[static_cast<std::size_t>(bin - kShares.begin()) - 1].add(truth, found);
    mistaken.add(truth, found);
  }
  std::printf("%s\n%12s %8s %8s %10s %8s %12s\n", folder.filename().c_str(), "people fill",
              "frames", "recall", "precision", "IoU", "half unseen");
  for (std::size_t b = 1; b < bins.size(); ++b) {
    const Overlap& bin = bins[b];
    if (bin.frames == 0) continue;
    std::printf("%3.0f to %3.0f %% %8d %8.2f %10.2f %8.3f %12d\n", 100 * kShares[b],
                100 * kShares[b + 1], bin.frames, bin.both / bin.truth,
                bin.both / std::max(1.0, bin.given), bin.both / (bin.truth + bin.given - bin.both),
                bin.unseen_frames);
  }
  std::printf(
      "away from people %.2f %% of the picture, at most %.1f %%, more than %.0f %% in %.1f %% "
      "of frames\n",
      100 * mistaken.shares / mistaken.frames, 100 * mistaken.largest, 100 * kMuch,
      100.0 * mistaken.frames_with_much / mistaken.frames);
}

}  // namespace
}  // namespace stillpoint

int main(int count, char** arguments) {
  std::vector<std::string> assignments, recordings;
  for (int i = 1; i < count; ++i)
    (std::string(arguments[i]).find('=') == std::string::npos ? recordings : assignments)
        .emplace_back(arguments[i]);
  if (recordings.empty()) {
    std::cerr << "usage: segmenter_accuracy [KEY=VALUE]... RECORDING...\n";
    return 2;
  }
  setenv("STILLPOINT_CONFIG_PATH", STILLPOINT_SOURCE_DIR "/configs", 0);
  setenv("STILLPOINT_PLUGIN_PATH", STILLPOINT_PLUGINS, 0);
  try {
    for (const std::string& recording : recordings) stillpoint::measure(recording, assignments);
  } catch (const stillpoint::Error& error) {
    std::cerr << error.what() << '\n';
    return 1;
  }
}
