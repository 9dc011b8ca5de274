#include "orb_slam/loop_closer.hpp"

#include <utility>

namespace stillpoint::orb_slam {
namespace {

double path_length(const SparseMap& map, KeyFrameId from, KeyFrameId to) {
  double metres = 0;
  Eigen::Vector3d last = map.world_from_keyframe(from).translation();
  for (KeyFrameId id = from + 1; id <= to; ++id) {
    const KeyFrame* keyframe = map.keyframe(id);
    if (!keyframe) continue;
    metres += (keyframe->world_from_camera.translation() - last).norm();
    last = keyframe->world_from_camera.translation();
  }
  return metres;
}

// Perceptual aliasing: rejects loops whose correction exceeds the drift that is possible.
bool is_within_drift(const SparseMap& map, const LoopMatch& loop, double max_drift) {
  // Metres; dynamic objects may have caused drift on a short path, and rooms that look alike are
  // farther apart than that.
  constexpr double kSlack = 0.5;
  const Eigen::Vector3d before = map.keyframe(loop.keyframe)->world_from_camera.translation();
  return (loop.world_from_camera.translation() - before).norm() <=
         kSlack + max_drift * path_length(map, loop.place, loop.keyframe);
}

}  // namespace

void OrbLoopCloser::Options::visit(OptionVisitor& v) {
  v("min_keyframes_between", min_keyframes_between,
    {.min = 0, .help = "least number of key frames between two loop closures"});
  v("max_drift", max_drift,
    {.min = 0,
     .help = "a loop that moves the camera by more than this share of the path travelled since, "
             "plus 0.5 m, is rejected as two places that look alike"});
  v("adjust_iterations", adjust_iterations,
    {.min = 0,
     .help = "iterations of the bundle adjustment of the whole map after a loop; 0: none"});
}

OrbLoopCloser::OrbLoopCloser(Options options, const StageContext&) : options_(options) {}

std::optional<MapCorrection> OrbLoopCloser::close(const SparseMap& map, KeyFrameId latest,
                                                  std::stop_token stop) {
  const std::vector<KeyFrameId> candidates = candidates_.find(map, latest);
  if (last_loop_ && latest < *last_loop_ + static_cast<KeyFrameId>(options_.min_keyframes_between))
    return std::nullopt;
  for (const KeyFrameId place : candidates) {
    if (stop.stop_requested()) return std::nullopt;
    const auto loop = match_loop(map, latest, place);
    if (loop && is_within_drift(map, *loop, options_.max_drift))
      return correct(map, *loop, std::move(stop));
  }
  return std::nullopt;
}

std::optional<MapCorrection> OrbLoopCloser::correct(const SparseMap& map, const LoopMatch& loop,
                                                    std::stop_token stop) {
  loops_.push_back({loop.place, loop.keyframe,
                    map.world_from_keyframe(loop.place).inverse() * loop.world_from_camera});
  std::vector<MovedKeyFrame> moved = optimise_pose_graph(map, loops_, std::move(stop));
  if (moved.empty()) {
    loops_.pop_back();
    return std::nullopt;
  }
  last_loop_ = loop.keyframe;
  return MapCorrection{.keyframe_id_end = static_cast<KeyFrameId>(map.keyframe_id_end()),
                       .moved = std::move(moved),
                       .fused = loop.same};
}

std::optional<MapCorrection> OrbLoopCloser::adjust(const SparseMap& map,
                                                   std::stop_token end_early) {
  if (options_.adjust_iterations == 0) return std::nullopt;
  return adjust_all(map, options_.adjust_iterations, end_early);
}

}  // namespace stillpoint::orb_slam
