#include "orb_slam/loop_closer.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stillpoint::orb_slam {
namespace {

// Dynamic objects may have caused drift on a short path; rooms that look alike are farther apart.
constexpr double kSlackMetres = 0.5;
constexpr double kSlackRadians = 0.5;
constexpr double kRadiansPerMetre = 0.02;
// Standard deviations of poses that landmarks did not constrain; no more than the path and a
// radian.
constexpr double kSigmas = 3;
constexpr double kMostSlackByDepth = 1;  // rad

// Between two key frames.
struct Path {
  double metres = 0;
  Matrix6d covariance = Matrix6d::Zero();  // sum of those of the key frames, as in PoseUncertainty
};

Path path_between(const SparseMap& map, KeyFrameId from, KeyFrameId to) {
  Path path;
  Eigen::Vector3d last = map.world_from_keyframe(from).translation();
  for (KeyFrameId id = from + 1; id <= to; ++id) {
    const KeyFrame* keyframe = map.keyframe(id);
    if (!keyframe) continue;
    path.metres += (keyframe->world_from_camera.translation() - last).norm();
    path.covariance += keyframe->covariance;
    last = keyframe->world_from_camera.translation();
  }
  return path;
}

// Perceptual aliasing: rejects loops whose correction exceeds the drift that is possible.
bool is_within_drift(const SparseMap& map, const LoopMatch& loop, double max_drift) {
  const Path path = path_between(map, loop.place, loop.keyframe);
  const Pose drift =
      map.keyframe(loop.keyframe)->world_from_camera.inverse() * loop.world_from_camera;
  const auto sigmas = [&](int first) {
    return kSigmas * std::sqrt(std::max(0.0, path.covariance.diagonal().segment<3>(first).sum()));
  };
  return drift.translation().norm() <=
             kSlackMetres + max_drift * path.metres + std::min(sigmas(0), path.metres) &&
         rotation_angle(drift) <= kSlackRadians + kRadiansPerMetre * path.metres +
                                      std::min(sigmas(3), kMostSlackByDepth);
}

}  // namespace

void OrbLoopCloser::Options::visit(OptionVisitor& v) {
  v("min_keyframes_between", min_keyframes_between,
    {.min = 0, .help = "least number of key frames between two loop closures"});
  v("max_drift", max_drift,
    {.min = 0,
     .help =
         "a loop that moves the camera by more than this share of the path travelled since, "
         "plus 0.5 m and what key frames say that depth left open, is rejected as two places that "
         "look alike; so is one that turns it by more than 29 degrees, plus 1.1 per metre"});
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
  std::erase_if(loops_, [&](const PoseEdge& edge) { return edge.a < map.keyframe_id_begin(); });
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
