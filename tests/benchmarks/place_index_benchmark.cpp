// Place recognition on simulated recordings, whose truth is known:
//   stillpoint simulate room_loop --frames 1920 -o DIR/room_loop
//   STILLPOINT_RECORDINGS=DIR STILLPOINT_EXAMPLES=OTHER_DIR place_index_benchmark
// With recordings in OTHER_DIR, a vocabulary tree trained on them is measured as well.
//
// Every eighth frame is a key frame. One that shows at least half of what a key frame of more than
// five seconds before showed has returned to a place. Candidates are right when they show at least
// 15 % of what is seen.
//
// returns: key frames that have returned. first, first_ten: share of them whose best candidate, or
// one of the ten best, is right. pN: precision at the score where N % of the returns are
// recognised by their best candidate. sure: most of them that are recognised without any fault.
// verified: share for which one of the ten passes the geometric verification. wrong: verified
// places whose pose is more than 10 cm or 3 degrees off. query_ms, match_ms: per query, per
// verification. Benchmarks named time/: every fourth frame is a key frame; add_ms per key frame.
#include <benchmark/benchmark.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "benchmarks/true_recording.hpp"
#include "benchmarks/vocabulary_tree.hpp"
#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/loop_match.hpp"
#include "orb_slam/observed_frame.hpp"
#include "orb_slam/orb_extractor.hpp"
#include "orb_slam/place_index.hpp"

namespace stillpoint::orb_slam {
namespace {

namespace fs = std::filesystem;

constexpr double kApart = 5.0;       // seconds
constexpr double kReturned = 0.5;    // share of the image seen before
constexpr double kSamePlace = 0.15;  // enough in common to be the same place
constexpr std::size_t kCandidates = 10;

struct Place {
  cv::Mat depth;  // metres
  Pose world_from_camera;
  double time = 0;
};

struct Recording {
  SparseMap map;
  std::vector<Place> places;  // by key frame
};

// Every measured feature is a landmark, seen once.
void add_keyframe(MapEdit& edit, const FramePtr& frame, const Pose& pose, OrbExtractor& orb) {
  const auto id = static_cast<KeyFrameId>(edit.map().keyframe_id_end());
  const ObservedFrame observed = observe(frame, orb.extract(frame->gray));
  const std::size_t count = observed.features->size();
  edit.add_keyframe({.id = id,
                     .frame = frame->index,
                     .time = frame->time,
                     .world_from_camera = pose,
                     .camera = frame->camera,
                     .features = observed.features,
                     .track_weights = observed.track_weights,
                     .map_weights = observed.map_weights,
                     .landmarks = std::vector<LandmarkId>(count, kNoId)});
  for (std::uint32_t i = 0; i < count; ++i) {
    const float depth = observed.features->depth[i];
    if (depth <= 0) continue;
    const cv::Point2f p = observed.features->keypoints[i].pt;
    const LandmarkId landmark =
        edit.add_landmark({.position_in_world = pose * frame->camera->unproject(p.x, p.y, depth),
                           .reference = id,
                           .created_by = id});
    edit.add_observation(landmark, {id, i});
    refresh_landmark(edit, landmark);
  }
}

Recording load(const fs::path& folder, int every) {
  OrbExtractor orb(OrbOptions{});
  MapEdit edit{SparseMap{}};
  Recording recording;
  for (const TrueFrame& read : read_true_frames(folder, every)) {
    recording.places.push_back({read.frame->depth, read.world_from_camera, read.frame->time});
    add_keyframe(edit, read.frame, read.world_from_camera, orb);
  }
  recording.map = std::move(edit).finish();
  return recording;
}

// Share of a grid of pixels of one place that the other measured at the same depth.
double overlap(const Place& from, const Place& to, const Camera& camera) {
  const Pose to_from = to.world_from_camera.inverse() * from.world_from_camera;
  int measured = 0, seen = 0;
  for (int v = 8; v < camera.height; v += 16)
    for (int u = 8; u < camera.width; u += 16) {
      const float depth = from.depth.at<float>(v, u);
      if (depth <= 0) continue;
      ++measured;
      const Eigen::Vector3d p = to_from * camera.unproject(u, v, depth);
      if (p.z() <= 0) continue;
      const Eigen::Vector2d at = camera.project(p);
      if (!camera.contains(at.x(), at.y())) continue;
      const float there = to.depth.at<float>(cvRound(at.y()), cvRound(at.x()));
      seen += std::abs(there - p.z()) < 0.1 * p.z();
    }
  return measured > 100 ? static_cast<double>(seen) / measured : 0;
}

bool same_place(const Recording& recording, KeyFrameId a, KeyFrameId b, double share) {
  const Camera& camera = *recording.map.keyframe(a)->camera;
  return overlap(recording.places[a], recording.places[b], camera) >= share;
}

bool before(const Recording& recording, KeyFrameId a, KeyFrameId b) {
  return recording.places[a].time < recording.places[b].time - kApart;
}

bool has_returned(const Recording& recording, KeyFrameId id) {
  for (KeyFrameId other = 0; other < id && before(recording, other, id); ++other)
    if (same_place(recording, id, other, kReturned)) return true;
  return false;
}

class Stopwatch {
 public:
  double milliseconds() const {
    const auto passed = std::chrono::steady_clock::now() - start_;
    return std::chrono::duration<double, std::milli>(passed).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// The best candidate of a key frame.
struct Answer {
  double score = 0;
  bool right = false;
  bool returned = false;
};

/// Precision where at least `recall` of the returns are recognised; 0 where so many never are.
double precision_at(std::vector<Answer> answers, double recall, int returns) {
  std::ranges::sort(answers, std::greater(), &Answer::score);
  int right = 0, all = 0;
  for (const Answer& answer : answers) {
    ++all;
    right += answer.right;
    if (right >= recall * returns) return static_cast<double>(right) / all;
  }
  return 0;
}

int right_before_the_first_fault(std::vector<Answer> answers) {
  std::ranges::sort(answers, std::greater(), &Answer::score);
  const auto fault = std::ranges::find(answers, false, &Answer::right);
  return static_cast<int>(std::count_if(answers.begin(), fault, std::mem_fn(&Answer::returned)));
}

/// How well one index recognises places of one recording.
class Recognition {
 public:
  using Query = std::function<std::vector<PlaceVote>(std::span<const Descriptor>)>;

  explicit Recognition(const Recording& recording) : recording_(recording) {}

  void ask(KeyFrameId id, const Query& query) {
    const Stopwatch watch;
    std::vector<PlaceVote> votes = query(place_descriptors(*recording_.map.keyframe(id)));
    query_ms_ += watch.milliseconds();
    ++queries_;
    std::erase_if(votes, [&](const PlaceVote& v) { return !before(recording_, v.keyframe, id); });
    votes.resize(std::min(votes.size(), kCandidates));
    const auto right = [&](const PlaceVote& v) {
      return same_place(recording_, id, v.keyframe, kSamePlace);
    };
    const bool returned = has_returned(recording_, id);
    returns_ += returned;
    first_ten_ += returned && std::ranges::any_of(votes, right);
    if (!votes.empty()) answers_.push_back({votes[0].score, right(votes[0]), returned});
    verified_ += verify(id, votes) && returned;
  }

  benchmark::UserCounters counters() const {
    const double all = std::max(returns_, 1);
    const auto first =
        std::ranges::count_if(answers_, [](const Answer& a) { return a.returned && a.right; });
    return {{"returns", returns_},
            {"first", static_cast<double>(first) / all},
            {"first_ten", first_ten_ / all},
            {"p50", precision_at(answers_, 0.5, returns_)},
            {"p90", precision_at(answers_, 0.9, returns_)},
            {"sure", right_before_the_first_fault(answers_) / all},
            {"verified", verified_ / all},
            {"wrong", wrong_},
            {"query_ms", query_ms_ / std::max(queries_, 1)},
            {"match_ms", match_ms_ / std::max(matches_, 1)}};
  }

 private:
  bool verify(KeyFrameId id, const std::vector<PlaceVote>& votes) {
    for (const PlaceVote& vote : votes) {
      const Stopwatch watch;
      const auto loop = match_loop(recording_.map, id, vote.keyframe);
      match_ms_ += watch.milliseconds();
      ++matches_;
      if (!loop) continue;
      judge(*loop);
      return true;
    }
    return false;
  }

  void judge(const LoopMatch& loop) {
    const Pose error =
        recording_.places[loop.keyframe].world_from_camera.inverse() * loop.world_from_camera;
    if (error.translation().norm() < 0.1 && rotation_angle(error) < 0.05) return;
    ++wrong_;
    std::fprintf(stderr, "wrong: key frame %u at %u, %.2f m off, %d inliers, support %.2f\n",
                 loop.keyframe, loop.place, error.translation().norm(), loop.inliers, loop.support);
  }

  const Recording& recording_;
  std::vector<Answer> answers_;
  int returns_ = 0, first_ten_ = 0, verified_ = 0, wrong_ = 0, queries_ = 0, matches_ = 0;
  double query_ms_ = 0, match_ms_ = 0;
};

void recognise_by_hashes(benchmark::State& state, const fs::path& folder) {
  const Recording recording = load(folder, 8);
  PlaceIndex index;
  index.update(recording.map);
  Recognition recognition(recording);
  for ([[maybe_unused]] auto _ : state)
    for (KeyFrameId id = 0; id < recording.places.size(); ++id)
      recognition.ask(id, [&](std::span<const Descriptor> view) { return index.query(view); });
  state.counters = recognition.counters();
}

const VocabularyTree& trained_tree() {
  static const VocabularyTree tree = [] {
    OrbExtractor orb(OrbOptions{});
    std::vector<Descriptor> examples;
    for (const fs::path& folder : recordings_in("STILLPOINT_EXAMPLES"))
      for (const TrueFrame& read : read_true_frames(folder, 4)) {
        const Features features = orb.extract(read.frame->gray);
        examples.insert(examples.end(), features.descriptors.begin(), features.descriptors.end());
      }
    return VocabularyTree(std::move(examples), 10, 5);
  }();
  return tree;
}

void recognise_by_tree(benchmark::State& state, const fs::path& folder) {
  const Recording recording = load(folder, 8);
  TreeIndex index(trained_tree());
  for (KeyFrameId id = 0; id < recording.places.size(); ++id)
    index.add(id, place_descriptors(*recording.map.keyframe(id)));
  index.finish();
  Recognition recognition(recording);
  for ([[maybe_unused]] auto _ : state)
    for (KeyFrameId id = 0; id < recording.places.size(); ++id)
      recognition.ask(id, [&](std::span<const Descriptor> view) { return index.query(view); });
  state.counters = recognition.counters();
  state.counters["words"] = static_cast<double>(trained_tree().words());
  state.counters["tree_MB"] = trained_tree().megabytes();
}

void time_of(benchmark::State& state, const fs::path& folder) {
  const Recording recording = load(folder, 4);
  const auto count = static_cast<double>(recording.places.size());
  const Stopwatch watch;
  PlaceIndex index;
  index.update(recording.map);
  const double add_ms = watch.milliseconds();
  KeyFrameId id = 0;
  for ([[maybe_unused]] auto _ : state) {
    benchmark::DoNotOptimize(index.query(place_descriptors(*recording.map.keyframe(id))));
    id = (id + 1) % static_cast<KeyFrameId>(recording.places.size());
  }
  state.counters = {{"keyframes", count}, {"add_ms", add_ms / count}};
}

void measure(const std::string& kind, void (*function)(benchmark::State&, const fs::path&),
             int iterations) {
  for (const fs::path& folder : recordings_to_measure()) {
    auto* entry =
        benchmark::RegisterBenchmark((kind + folder.filename().string()).c_str(),
                                     [=](benchmark::State& state) { function(state, folder); });
    entry->Unit(benchmark::kMillisecond)->Iterations(iterations);
  }
}

const bool kRegistered = [] {
  measure("hashes/", recognise_by_hashes, 1);
  if (!recordings_in("STILLPOINT_EXAMPLES").empty()) measure("tree/", recognise_by_tree, 1);
  measure("time/", time_of, 500);
  return true;
}();

}  // namespace
}  // namespace stillpoint::orb_slam
