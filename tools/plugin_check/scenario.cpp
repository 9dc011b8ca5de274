#include "plugin_check/scenario.hpp"

#include <functional>
#include <opencv2/core.hpp>
#include <utility>

#include "stillpoint/contracts/loop_closer.hpp"
#include "stillpoint/contracts/output.hpp"
#include "stillpoint/contracts/tracker.hpp"
#include "stillpoint/runtime/read_only_images.hpp"
#include "stillpoint/support/objects.hpp"

namespace stillpoint::plugin_check {
namespace {

using testing::TestRecording;
using testing::TestRecordingOptions;

constexpr int kUsualFrames = 20, kFewFrames = 6;
constexpr std::uint32_t kLargeIndex = 3'000'000'000;
constexpr KeyFrameId kLargeId = 66'000;  // beyond 16 bits

Scenario scenario_of(const TestRecordingOptions& options) {
  const TestRecording recording(options);
  Scenario scenario;
  for (std::size_t i = 0; i < recording.size(); ++i)
    scenario.inputs.push_back({recording.frame(i),
                               recording.segmentation(i),
                               recording.moving_points(i),
                               {},
                               recording.weights(i),
                               recording.world_from_camera(i)});
  return scenario;
}

/// Free-space violations on the person, and static surfaces elsewhere, on cells of 4 px.
MapEvidence evidence_of(const Input& input) {
  constexpr int kCell = 4;
  const cv::Mat& labels = input.segmentation->labels;
  MapEvidence evidence;
  evidence.log_odds.create(labels.rows / kCell, labels.cols / kCell, CV_32F);
  for (int y = 0; y < evidence.log_odds.rows; ++y)
    for (int x = 0; x < evidence.log_odds.cols; ++x)
      evidence.log_odds.at<float>(y, x) = labels.at<std::uint8_t>(kCell * y, kCell * x) ? 3 : -3;
  return evidence;
}

/// The frames of a scenario with their images changed, from the second one on.
Scenario with_frames(Scenario scenario, const std::function<void(Frame&)>& change) {
  for (std::size_t i = 1; i < scenario.inputs.size(); ++i) {
    Frame frame = *scenario.inputs[i].frame;
    frame.bgr = frame.bgr.clone();
    frame.gray = frame.gray.clone();
    frame.depth = frame.depth.clone();
    change(frame);
    scenario.inputs[i].frame = std::make_shared<const Frame>(std::move(frame));
  }
  return scenario;
}

/// The same frames with other labels, points or weights.
Scenario with_inputs(Scenario scenario, const std::function<void(Input&)>& change) {
  scenario.of_images = false;
  for (Input& input : scenario.inputs) change(input);
  return scenario;
}

Scenario named(Scenario scenario, std::string name, std::string why, std::string remedy) {
  scenario.name = std::move(name);
  scenario.why = std::move(why);
  scenario.remedy = std::move(remedy);
  return scenario;
}

void label_everything(Input& input) {
  auto segmentation = std::make_shared<Segmentation>();
  segmentation->frame = input.frame->index;
  segmentation->labels = cv::Mat(input.frame->gray.size(), CV_8UC1, cv::Scalar(1));
  find_objects(*segmentation, 1);
  input.segmentation = std::move(segmentation);
}

void know_nothing(Input& input) {
  auto segmentation = std::make_shared<Segmentation>();
  segmentation->frame = input.frame->index;
  input.segmentation = std::move(segmentation);
  input.moving = {};
  input.evidence = {};
  input.weights = std::make_shared<const StaticWeights>();
}

void use_nothing(Input& input) {
  auto weights = std::make_shared<StaticWeights>();
  weights->track = cv::Mat::zeros(input.frame->gray.size(), CV_8UC1);
  weights->map = weights->track;
  input.weights = std::move(weights);
}

void protect_images(Scenario& scenario) {
  for (Input& input : scenario.inputs)
    input.frame = std::make_shared<const Frame>(with_read_only_images(*input.frame));
}

/// Cases of images, labels and weights, for stages of every kind.
void add_general(std::vector<Scenario>& all, const Scenario& usual, const Scenario& few) {
  all.push_back(named(usual, "usual recording", "no run can use the stage",
                      "the contract's header says what each function must give; how to follow a "
                      "case with gdb: the page 'Debugging a plugin'"));
  all.back().is_usual = true;
  all.push_back(named(
      with_frames(few, [](Frame& frame) { frame.depth = cv::Scalar(0); }), "images without depth",
      "a sensor measures nothing that is too near, and nothing in the sun",
      "a depth of 0 is no measurement: test for it, and expect that no pixel is left"));
  all.push_back(named(with_frames(few,
                                  [](Frame& frame) {
                                    frame.bgr = cv::Scalar(0, 0, 0);
                                    frame.gray = cv::Scalar(0);
                                  }),
                      "black images", "somebody switches the light off, or covers the lens",
                      "expect that no feature, corner or point is found"));
  all.push_back(named(with_inputs(few, know_nothing), "no labels, no moving points, no weights",
                      "each of these boxes can be left out of a pipeline; images are empty then",
                      "test labels, log_odds, track and map for empty(), which means: nothing is "
                      "known, or everything counts in full"));
  all.push_back(named(with_inputs(few, label_everything), "everything is a person",
                      "networks do that in pictures that they do not understand",
                      "expect that no background is left"));
  all.push_back(named(with_inputs(few, use_nothing), "all weights are 0",
                      "people can fill the whole picture", "expect that no pixel may be used"));
  all.push_back(named(scenario_of({.frames = kFewFrames, .metres_per_second = 0, .person = false}),
                      "a camera at rest", "motions of 0 have no direction",
                      "expect that previous and current image are the same"));
  all.push_back(named(scenario_of({.frames = kFewFrames, .width = 161, .height = 121}),
                      "images of 161 x 121 pixels",
                      "cameras have different sizes, also odd ones; rows need not be aligned",
                      "take sizes from the frame, and addresses from Mat::ptr or Mat::at"));
  all.push_back(named(scenario_of({.frames = 1}), "a single frame",
                      "a recording may end at once, and a run may be stopped",
                      "do not count on a second call"));
}

/// Cases that only stages of one kind can meet.
void add_of_kinds(std::vector<Scenario>& all, const Scenario& usual, const Scenario& few) {
  Scenario localised = usual;
  localised.kind = Tracker::kKind;
  localised.localised_from = kUsualFrames / 2;
  all.push_back(named(std::move(localised), "a map that stays as it is",
                      "robots are localised in the map of a building (--localise-only)",
                      "track on the given map, and make no key frame with "
                      "TrackHints::localise_only"));
  Scenario pushed = few;
  pushed.kind = Output::kKind;
  pushed.is_pushed = true;
  all.push_back(named(std::move(pushed), "frames that a program gives",
                      "Stillpoint can be a part of another program, which steers the run itself",
                      "expect that begin() is not called"));
  Scenario round_trip;
  round_trip.kind = LoopCloser::kKind;
  round_trip.is_round_trip = true;
  all.push_back(named(std::move(round_trip), "a place seen again",
                      "closing such a loop is what a loop closer is for",
                      "the map grows by landmarks of things that it had already: compare the "
                      "newest key frame with those that it shares none with"));
}

void add_large_ids(std::vector<Scenario>& all) {
  Scenario large = scenario_of({.frames = kFewFrames, .first_index = kLargeIndex});
  large.first_keyframe = kLargeId;
  all.push_back(
      named(std::move(large), "large indices and ids",
            "saved maps are gone on with, and runs last for days",
            "keep indices and ids in 32 bits without a sign; the ids of a map have gaps"));
}

}  // namespace

KeyFrame Scenario::keyframe(std::size_t i, KeyFrameId id) const {
  const Input& input = inputs.at(i);
  return testing::orb_keyframe(*input.frame, *input.weights, input.world_from_camera, id);
}

DenseKeyFrame Scenario::dense_keyframe(std::size_t i, KeyFrameId id) const {
  const Input& input = inputs.at(i);
  return {id, input.frame, input.segmentation, input.weights, input.world_from_camera};
}

std::vector<Scenario> make_scenarios() {
  Scenario usual = scenario_of({.frames = kUsualFrames});
  for (Input& input : usual.inputs) input.evidence = evidence_of(input);
  Scenario few = usual;
  few.inputs.resize(kFewFrames);

  std::vector<Scenario> all;
  add_general(all, usual, few);
  add_of_kinds(all, usual, few);
  add_large_ids(all);
  for (Scenario& scenario : all) protect_images(scenario);
  return all;
}

}  // namespace stillpoint::plugin_check
