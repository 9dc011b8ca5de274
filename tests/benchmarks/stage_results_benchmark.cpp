// What the checks of all stages' results take per frame (runtime.validate: cheap), those of a map
// per key frame, and those of `full`: of a frame of 640 x 480 with ten objects, 1,000 followed
// points, a key frame of 2,000 features, in a map of 300 key frames and 20,000 landmarks.
#include <benchmark/benchmark.h>

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/runtime/mapping_results.hpp"
#include "stillpoint/runtime/perception_results.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint {
namespace {

const cv::Size kSize(640, 480);
constexpr std::size_t kClasses = 21;
constexpr std::size_t kFeatures = 2000;
constexpr KeyFrameId kKeyFrames = 300;
constexpr LandmarkId kLandmarks = 20'000;

Frame frame_at(std::uint32_t index, const std::shared_ptr<const Camera>& camera) {
  return {.index = index,
          .time = index / 30.0,
          .bgr = cv::Mat(kSize, CV_8UC3, cv::Scalar::all(90)),
          .gray = cv::Mat(kSize, CV_8UC1, cv::Scalar(90)),
          .depth = cv::Mat(kSize, CV_32FC1, cv::Scalar(2)),
          .camera = camera};
}

KeyFrame keyframe_of(const Frame& frame, KeyFrameId id) {
  auto features = std::make_shared<Features>();
  features->levels = 8;
  features->keypoints.assign(kFeatures, cv::KeyPoint(100, 100, 31));
  features->descriptors.resize(kFeatures);
  features->depth.assign(kFeatures, 2.0F);
  KeyFrame keyframe;
  keyframe.id = id;
  keyframe.frame = frame.index;
  keyframe.time = frame.time;
  keyframe.camera = frame.camera;
  keyframe.features = std::move(features);
  keyframe.track_weights.assign(kFeatures, 255);
  keyframe.map_weights.assign(kFeatures, 255);
  for (std::size_t i = 0; i < kFeatures; ++i)
    keyframe.landmarks.push_back(static_cast<LandmarkId>(i * 7919 % kLandmarks));
  return keyframe;
}

/// What all stages give for one frame.
struct Results {
  std::shared_ptr<const Camera> camera = std::make_shared<const Camera>();
  Frame previous = frame_at(kKeyFrames, camera);
  Frame frame = frame_at(kKeyFrames + 1, camera);
  Segmentation labels;
  MovingPoints moving;
  MapEvidence evidence{.log_odds = cv::Mat(120, 160, CV_32FC1, cv::Scalar(0.5))};
  StaticWeights weights{.track = cv::Mat(kSize, CV_8UC1, cv::Scalar(255)),
                        .map = cv::Mat(kSize, CV_8UC1, cv::Scalar(255))};
  TrackResult tracked;
  TrackHints hints;
  SparseMap map;

  Results() {
    labels.frame = frame.index;
    labels.labels = cv::Mat(kSize, CV_8UC1, cv::Scalar(kClasses - 1));
    labels.instances = cv::Mat(kSize, CV_8UC1, cv::Scalar(10));
    labels.objects.assign(10, {.label = 15, .box = {20, 20, 200, 300}, .pixels = 50'000});
    moving.points.assign(1000, {.previous = {100, 100}, .current = {101, 100}});
    moving.camera_motion = Pose::Identity();
    MapEdit edit{SparseMap{}};
    for (LandmarkId id = 0; id < kLandmarks; ++id) edit.add_landmark({});
    for (KeyFrameId id = 0; id < kKeyFrames; ++id)
      edit.add_keyframe(keyframe_of(frame_at(id, camera), id));
    map = std::move(edit).finish();
    hints.next_keyframe = kKeyFrames;
    tracked.state = TrackState::kTracking;
    tracked.reference = 0;
    tracked.keyframe = keyframe_of(frame, kKeyFrames);
  }
};

void BasicChecks(benchmark::State& state) {
  const Results results;
  for (auto _ : state) {
    check_frame(results.frame, results.frame.index, &results.previous);
    check_segmentation(results.labels, results.frame, kClasses);
    check_moving_points(results.moving, kSize);
    check_evidence(results.evidence, kSize);
    check_weights(results.weights, results.labels, kSize);
    check_tracking(results.tracked, results.frame, results.map, results.hints);
  }
}
BENCHMARK(BasicChecks)->Unit(benchmark::kMillisecond);

/// Of local mapping, per key frame: 20 key frames and 2,000 landmarks have changed.
void MapChecks(benchmark::State& state) {
  const Results results;
  MapEdit edit(results.map);
  for (KeyFrameId id = 0; id < 20; ++id) edit.keyframe(id);
  for (LandmarkId id = 0; id < 2000; ++id) edit.landmark(10 * id);
  const SparseMap map = std::move(edit).finish();
  for (auto _ : state) check_refined(map, results.map);
}
BENCHMARK(MapChecks)->Unit(benchmark::kMillisecond);

void ThoroughChecks(benchmark::State& state) {
  const Results results;
  for (auto _ : state) {
    check_thoroughly(results.frame);
    check_thoroughly(results.moving);
    check_thoroughly(results.evidence);
    check_thoroughly(results.tracked);
  }
}
BENCHMARK(ThoroughChecks)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace stillpoint
