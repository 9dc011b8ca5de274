// Place recognition on simulated recordings, whose truth is known:
//   stillpoint simulate room_loop -o DIR/room_loop
//   STILLPOINT_RECORDINGS=DIR place_index_benchmark
//
// Every eighth frame is a key frame. One that shows at least half of what a key frame of more than
// five seconds before showed has returned to a place.
//
// returns: key frames that have returned. first, first_ten: share of them whose best candidate, or
// one of the ten best, shows the place. verified: share for which one of the ten passes the
// geometric verification. wrong: verified places whose pose is more than 10 cm or 3 degrees off.
// query_ms, match_ms: per query, per verification.
#include <benchmark/benchmark.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <vector>

#include "benchmarks/true_recording.hpp"
#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/loop_match.hpp"
#include "orb_slam/observed_frame.hpp"
#include "orb_slam/orb_extractor.hpp"
#include "orb_slam/place_index.hpp"

namespace stillpoint::orb {
namespace {

namespace fs = std::filesystem;

constexpr int kEvery = 8;          // frames
constexpr double kApart = 5.0;     // seconds
constexpr double kSameView = 0.5;  // share of the image

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

Recording load(const fs::path& folder) {
  OrbExtractor orb(OrbOptions{});
  MapEdit edit{SparseMap{}};
  Recording recording;
  for (const TrueFrame& read : read_true_frames(folder, kEvery)) {
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

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

void recognise(benchmark::State& state, const fs::path& folder) {
  const Recording recording = load(folder);
  const Camera& camera = *recording.map.keyframe(0)->camera;
  PlaceIndex index;
  index.update(recording.map);
  int returns = 0, first = 0, first_ten = 0, verified = 0, wrong = 0, queries = 0, matches = 0;
  double query_ms = 0, match_ms = 0;
  for ([[maybe_unused]] auto _ : state) {
    for (KeyFrameId id = 0; id < recording.places.size(); ++id) {
      const Place& here = recording.places[id];
      const auto before = [&](KeyFrameId other) {
        return recording.places[other].time < here.time - kApart;
      };
      const auto same = [&](KeyFrameId other) {
        return before(other) && overlap(here, recording.places[other], camera) >= kSameView;
      };
      const auto start = std::chrono::steady_clock::now();
      std::vector<PlaceVote> votes = index.query(place_descriptors(*recording.map.keyframe(id)));
      query_ms += milliseconds_since(start);
      ++queries;
      std::erase_if(votes, [&](const PlaceVote& vote) { return !before(vote.keyframe); });
      votes.resize(std::min<std::size_t>(votes.size(), 10));

      bool returned = false, found = false, passed = false;
      for (KeyFrameId other = 0; other < id && !returned; ++other) returned = same(other);
      for (const PlaceVote& vote : votes) found = found || same(vote.keyframe);
      for (const PlaceVote& vote : votes) {
        const auto match_start = std::chrono::steady_clock::now();
        const auto loop = match_loop(recording.map, id, vote.keyframe);
        match_ms += milliseconds_since(match_start);
        ++matches;
        if (!loop) continue;
        const Pose error = here.world_from_camera.inverse() * loop->world_from_camera;
        const bool right = error.translation().norm() < 0.1 && rotation_angle(error) < 0.05;
        if (!right)
          std::printf("wrong: %u at %u, inliers %d, support %.2f\n", id, vote.keyframe,
                      loop->inliers, loop->support);
        wrong += !right;
        passed = true;
        break;
      }
      returns += returned;
      first += returned && !votes.empty() && same(votes.front().keyframe);
      first_ten += returned && found;
      verified += returned && passed;
    }
  }
  const double all = std::max(returns, 1);
  state.counters = {{"keyframes", recording.places.size()},
                    {"returns", returns},
                    {"first", first / all},
                    {"first_ten", first_ten / all},
                    {"verified", verified / all},
                    {"wrong", wrong},
                    {"query_ms", query_ms / queries},
                    {"match_ms", match_ms / std::max(matches, 1)}};
}

const bool kRegistered = [] {
  for (const fs::path& folder : recordings_to_measure())
    benchmark::RegisterBenchmark(folder.filename().c_str(),
                                 [=](benchmark::State& state) { recognise(state, folder); })
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  return true;
}();

}  // namespace
}  // namespace stillpoint::orb
