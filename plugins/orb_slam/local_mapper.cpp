#include "orb_slam/local_mapper.hpp"

#include <algorithm>

#include "orb_slam/culling.hpp"
#include "orb_slam/landmark_creation.hpp"
#include "orb_slam/landmark_fusion.hpp"
#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/orb_keyframe.hpp"
#include "orb_slam/static_evidence.hpp"

namespace stillpoint::orb_slam {
namespace {

/// Landmarks that prove to have moved are removed.
void add_evidence(MapEdit& edit, const std::vector<LandmarkEvidence>& evidence) {
  for (const LandmarkEvidence& e : evidence) {
    const LandmarkId id = edit.map().current_id(e.landmark);
    if (id == kNoId) continue;
    Landmark& landmark = edit.landmark(id);
    landmark.visible += e.visible;
    landmark.found += e.found;
    landmark.static_log_odds = std::clamp(landmark.static_log_odds + e.static_log_odds,
                                          -kMaxStaticLogOdds, kMaxStaticLogOdds);
    if (landmark.static_log_odds < kMovedLogOdds) edit.remove_landmark(id);
  }
}

}  // namespace

void OrbLocalMapper::Options::visit(OptionVisitor& v) {
  v("neighbours", neighbours,
    {.min = 1, .help = "covisible key frames used for triangulation and fusion"});
  v("redundant_share", redundant_share,
    {.min = 0,
     .max = 1,
     .help = "a key frame is removed when three others see more than this share of its landmarks"});
  v("bundle_keyframes", bundle_keyframes,
    {.min = 2,
     .help = "key frames whose poses the local bundle adjustment optimises; more: more accurate, "
             "slower"});
  v("bundle_iterations", bundle_iterations,
    {.min = 1, .help = "iterations of the local bundle adjustment"});
}

OrbLocalMapper::OrbLocalMapper(Options options, const StageContext&)
    : options_(options),
      bundle_{.max_keyframes = options.bundle_keyframes,
              .max_iterations = options.bundle_iterations} {}

SparseMap OrbLocalMapper::insert(SparseMap map, KeyFrame keyframe) {
  require_orb(keyframe);
  MapEdit edit(std::move(map));
  const KeyFrameId id = keyframe.id;
  add_evidence(edit, keyframe.evidence);
  keyframe.evidence.clear();
  edit.add_keyframe(std::move(keyframe));
  for (const LandmarkId landmark : std::vector(edit.map().keyframe(id)->landmarks))
    if (landmark != kNoId) refresh_landmark(edit, landmark);
  remember(create_from_depth(edit, id));
  edit.update_covisibility(id);
  return std::move(edit).finish();
}

SparseMap OrbLocalMapper::refine(SparseMap map, KeyFrameId id, std::stop_token end_early) {
  MapEdit edit(std::move(map));
  cull_landmarks(edit, id, recent_);
  remember(triangulate(edit, id, options_.neighbours));
  if (!end_early.stop_requested()) fuse_with_neighbours(edit, id, options_.neighbours);
  edit.update_covisibility(id);
  if (!end_early.stop_requested() && edit.map().keyframe_count() > 2) {
    for (const LandmarkId landmark : adjust_locally(edit, id, bundle_, end_early))
      refresh_landmark(edit, landmark);
    cull_keyframes(edit, id, options_.redundant_share);
  }
  return std::move(edit).finish();
}

void OrbLocalMapper::remember(const std::vector<LandmarkId>& created) {
  recent_.insert(recent_.end(), created.begin(), created.end());
}

}  // namespace stillpoint::orb_slam
