#include "stillpoint/contracts/map_correction.hpp"

#include <set>
#include <unordered_map>
#include <unordered_set>
#include <utility>

namespace stillpoint {
namespace {

using Poses = std::unordered_map<KeyFrameId, Pose>;

// Poses after the correction, of those key frames that it moves. Parents are older than their
// children, so one pass in order of id carries the correction on to the newer key frames.
Poses corrected_poses(const MapCorrection& correction, const SparseMap& map) {
  Poses moved;
  for (const MovedKeyFrame& m : correction.moved)
    if (map.keyframe(m.keyframe)) moved[m.keyframe] = m.world_from_camera;
  for (KeyFrameId id = correction.keyframe_id_end; id < map.keyframe_id_end(); ++id) {
    const KeyFrame* keyframe = map.keyframe(id);
    if (!keyframe || keyframe->parent == kNoId) continue;
    const auto parent = moved.find(keyframe->parent);
    if (parent == moved.end()) continue;
    const Pose parent_from_keyframe =
        map.keyframe(keyframe->parent)->world_from_camera.inverse() * keyframe->world_from_camera;
    moved[id] = parent->second * parent_from_keyframe;
  }
  return moved;
}

// To where they were optimised, or with their reference key frames.
void move_landmarks(const MapCorrection& correction, const Poses& moved, MapEdit& edit) {
  std::unordered_set<LandmarkId> placed;
  for (const auto& [id, position] : correction.landmarks) {
    if (!edit.map().landmark(id)) continue;
    edit.landmark(id).position_in_world = position;
    placed.insert(id);
  }
  for (LandmarkId id = 0; id < edit.map().landmark_id_end(); ++id) {
    const Landmark* landmark = edit.map().landmark(id);
    if (!landmark || placed.contains(id)) continue;
    const auto reference = moved.find(landmark->reference);
    if (reference == moved.end()) continue;
    const Pose move =
        reference->second * edit.map().keyframe(landmark->reference)->world_from_camera.inverse();
    Landmark& own = edit.landmark(id);
    own.position_in_world = move * own.position_in_world;
    own.mean_view = move.linear() * own.mean_view;
  }
}

void fuse_landmarks(const MapCorrection& correction, MapEdit& edit) {
  std::set<KeyFrameId> touched;
  for (const auto& [kept, gone] : correction.fused) {
    const LandmarkId a = edit.map().current_id(kept);
    const LandmarkId b = edit.map().current_id(gone);
    if (a == kNoId || b == kNoId || a == b) continue;
    edit.fuse_landmarks(a, b);
    for (const Observation& o : edit.map().landmark(a)->observations) touched.insert(o.keyframe);
  }
  for (const KeyFrameId id : touched) edit.update_covisibility(id);
}

}  // namespace

SparseMap apply(const MapCorrection& correction, SparseMap map) {
  MapEdit edit(std::move(map));
  const Poses moved = corrected_poses(correction, edit.map());
  move_landmarks(correction, moved, edit);
  for (const auto& [id, pose] : moved) edit.keyframe(id).world_from_camera = pose;
  fuse_landmarks(correction, edit);
  return std::move(edit).finish();
}

}  // namespace stillpoint
