#include "stillpoint/runtime/mapping_results.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "stillpoint/runtime/map_values.hpp"
#include "stillpoint/runtime/stage_requirement.hpp"

namespace stillpoint {
namespace {

constexpr double kSamePose = 1e-6;  // relative difference of two matrices
// The same, of products: with matrices that are as skew as they may be, and their transposes for
// their inverses.
constexpr double kSameProduct = 2 * kLargestSkew;

/// Of a correction; `what`: "key frame" or "landmark".
void check_id(std::uint32_t id, std::size_t end, const std::string& what) {
  require_of_stage(id < end,
                   "the correction names " + what + " " +
                       (id == kNoId ? "kNoId" : std::to_string(id)) + " of " + std::to_string(end),
                   "use ids of the map that it was computed on");
}

bool same(const Camera& a, const Camera& b) {
  return a.width == b.width && a.height == b.height && a.fx == b.fx && a.fy == b.fy &&
         a.cx == b.cx && a.cy == b.cy;
}

/// Camera, features, and one of everything per keypoint. `what`: "the key frame" or "key frame 7".
void check_parts(const KeyFrame& keyframe, const std::string& what, const SparseMap& map) {
  require_of_stage(keyframe.camera != nullptr, what + " has no camera",
                   "give it that of the frame");
  require_of_stage(keyframe.features != nullptr, what + " has no features",
                   "a tracker without point features gives an empty Features");
  const Features& features = *keyframe.features;
  const std::size_t count = features.size();
  const auto require_count = [&](std::size_t size, const std::string& of) {
    require_of_stage(size == count,
                     what + " has " + std::to_string(count) + " keypoints, but " +
                         std::to_string(size) + " " + of,
                     "give one of each per keypoint");
  };
  if (!features.descriptors.empty()) require_count(features.descriptors.size(), "descriptors");
  require_count(features.depth.size(), "depths");
  require_count(keyframe.track_weights.size(), "track weights");
  require_count(keyframe.map_weights.size(), "map weights");
  require_count(keyframe.landmarks.size(), "landmarks");
  require_of_stage(
      std::ranges::all_of(keyframe.landmarks,
                          [&](LandmarkId id) { return id == kNoId || id < map.landmark_id_end(); }),
      what + " sees a landmark that is not in the map", "use ids of the map that was given");
}

void check_evidence(std::span<const LandmarkEvidence> all, const SparseMap& map) {
  for (const LandmarkEvidence& evidence : all) {
    require_of_stage(evidence.landmark < map.landmark_id_end(),
                     "the key frame has evidence of a landmark that is not in the map",
                     "use ids of the map that track() was given");
    require_of_stage(std::isfinite(evidence.static_log_odds),
                     "the evidence of a landmark is not finite", "leave out what is not known");
  }
}

void check_keyframe(const KeyFrame& keyframe, const Frame& frame, const SparseMap& map,
                    KeyFrameId next) {
  require_of_stage(keyframe.id == next,
                   "the key frame has id " + std::to_string(keyframe.id) +
                       ", but the next one is " + std::to_string(next),
                   "take TrackHints::next_keyframe");
  require_of_stage(keyframe.frame == frame.index,
                   "the key frame is of frame " + std::to_string(keyframe.frame),
                   "KeyFrame::frame must be the index of the frame that was tracked");
  require_of_stage(keyframe.time == frame.time,
                   "the time of the key frame is not that of its frame",
                   "set KeyFrame::time to Frame::time");
  check_parts(keyframe, "the key frame", map);
  require_of_stage(possible(*keyframe.camera) && same(*keyframe.camera, *frame.camera),
                   "the camera of the key frame is not that of its frame",
                   "set KeyFrame::camera to Frame::camera");
  require_of_stage(is_rigid_motion(keyframe.world_from_camera),
                   "the pose of the key frame is no rigid motion",
                   "it must be finite, with an orthonormal rotation");
  check_evidence(keyframe.evidence, map);
  const std::string fault = fault_of(*keyframe.features, *keyframe.camera);
  require_of_stage(fault.empty(), "the key frame has wrong features: " + fault,
                   "positions are in pixels of the frame, octaves count from 0 to "
                   "Features::levels - 1, a depth of 0 stands for no measurement");
  require_of_stage(keyframe.covariance.allFinite(), "the covariance of the key frame is not finite",
                   "leave it 0 where it is not known");
}

/// The pose by the reference, which trajectories follow, is that of the result.
void check_reference(const TrackResult& result, const Pose& world_from_reference) {
  const Pose pose = world_from_reference * result.reference_from_camera;
  require_of_stage(pose.isApprox(result.world_from_camera, kSameProduct),
                   "reference_from_camera and world_from_camera are two different poses",
                   "world_from_camera = map.world_from_keyframe(reference) * "
                   "reference_from_camera");
}

/// That both sides of each link agree is looked at by check_thoroughly().
void check_observations(const Landmark& landmark, const SparseMap& map) {
  for (const Observation& seen : landmark.observations) {
    const KeyFrame* keyframe = map.keyframe(seen.keyframe);
    require_of_stage(
        keyframe && seen.feature < keyframe->landmarks.size(),
        "landmark " + std::to_string(landmark.id) + " is seen as a feature that is not in the map",
        "change observations with MapEdit::add_observation() and "
        "remove_observation()");
  }
}

/// Key frames and landmarks that `before` does not have, or not as they are now.
void check_changes(const SparseMap& map, const SparseMap& before) {
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id) {
    const KeyFrame* keyframe = map.keyframe(id);
    if (!keyframe || keyframe == before.keyframe(id)) continue;
    const std::string name = "key frame " + std::to_string(id);
    require_of_stage(is_rigid_motion(keyframe->world_from_camera),
                     "the pose of " + name + " is no rigid motion",
                     "it must be finite, with an orthonormal rotation");
    check_parts(*keyframe, name, map);
  }
  for (LandmarkId id = 0; id < map.landmark_id_end(); ++id) {
    const Landmark* landmark = map.landmark(id);
    if (!landmark || landmark == before.landmark(id)) continue;
    check_observations(*landmark, map);
    const std::string fault = fault_of(*landmark);
    require_of_stage(fault.empty(), "landmark " + std::to_string(id) + " is wrong: " + fault,
                     "remove landmarks whose position is not known");
  }
}

void check_begin(const TrackResult& result, const TrackHints& hints) {
  require_of_stage(hints.may_begin_anew, "it begins the map anew, but may not",
                   "do it with TrackHints::may_begin_anew only");
  require_of_stage(result.keyframe && result.reference == result.keyframe->id,
                   "it begins the map anew without a key frame that is its reference",
                   "give the first key frame of the new map");
  require_of_stage(result.world_from_camera.isApprox(Pose::Identity(), kSamePose),
                   "it begins the map anew elsewhere than at the origin",
                   "the first key frame has the identity as its pose");
  require_of_stage(std::ranges::count(result.keyframe->landmarks, kNoId) ==
                           std::ssize(result.keyframe->landmarks) &&
                       result.keyframe->evidence.empty(),
                   "it begins the map anew with landmarks of the map before",
                   "they are gone: give kNoId, and no evidence");
}

}  // namespace

void check_prepared(const PreparedFrame* prepared, const Frame& frame) {
  require_of_stage(prepared != nullptr, "prepare() gave nothing",
                   "give a PreparedFrame with the frame, of your own type or not");
  require_of_stage(prepared->frame.get() == &frame, "prepare() gave another frame",
                   "make it with the frame that prepare() was given");
}

void check_tracking(const TrackResult& result, const Frame& frame, const SparseMap& map,
                    const TrackHints& hints) {
  if (result.keyframe) {
    require_of_stage(!hints.localise_only, "it made a key frame, but the map stays as it is",
                     "make none with TrackHints::localise_only");
    require_of_stage(result.state == TrackState::kTracking,
                     "it made a key frame, but is " + std::string(name_of(result.state)),
                     "a key frame needs a pose: make it with kTracking only");
    check_keyframe(*result.keyframe, frame, map, hints.next_keyframe);
  }
  if (result.begins_anew) check_begin(result, hints);
  require_of_stage(result.features >= 0 && result.matches >= 0 && result.inliers >= 0,
                   "a number of features, matches or inliers is negative",
                   "leave them 0 where there are none");
  require_of_stage(std::ranges::all_of(result.tracked,
                                       [](const TrackedFeature& feature) {
                                         return std::isfinite(feature.pixel.x + feature.pixel.y);
                                       }),
                   "the pixel of a tracked feature is not finite", "leave out such features");
  if (result.state != TrackState::kTracking) return;
  require_of_stage(
      is_rigid_motion(result.world_from_camera) && is_rigid_motion(result.reference_from_camera),
      "the pose is no rigid motion",
      "it must be finite, with an orthonormal rotation; return kLost where there is none");
  require_of_stage(
      !result.keyframe ||
          result.keyframe->world_from_camera.isApprox(result.world_from_camera, kSamePose),
      "the key frame has another pose than its frame", "world_from_camera is the same in both");
  const KeyFrameId end = hints.next_keyframe + (result.keyframe ? 1 : 0);
  require_of_stage(result.reference < end && result.reference >= map.keyframe_id_begin(),
                   "the reference is key frame " +
                       (result.reference == kNoId ? "kNoId" : std::to_string(result.reference)) +
                       " of " + std::to_string(end),
                   "TrackResult::reference must be a key frame of the map, or the one just made");
  if (result.reference < map.keyframe_id_end())
    check_reference(result, map.world_from_keyframe(result.reference));
  else if (result.reference == hints.next_keyframe)
    check_reference(result, result.keyframe->world_from_camera);
}

void check_inserted(const SparseMap& map, const SparseMap& before) {
  const std::size_t end = before.keyframe_id_end();
  require_of_stage(map.keyframe_id_end() == end + 1 && map.keyframe(static_cast<KeyFrameId>(end)),
                   "key frame " + std::to_string(end) + " was not added to the map",
                   "insert() adds it, under its own id; refine() may remove it");
  check_refined(map, before);
}

void check_refined(const SparseMap& map, const SparseMap& before) {
  require_of_stage(map.keyframe_id_end() >= before.keyframe_id_end() &&
                       map.landmark_id_end() >= before.landmark_id_end(),
                   "ids of the map are gone", "give the next version of the map it was given");
  require_of_stage(map.keyframe_id_begin() == before.keyframe_id_begin(), "it cleared the map",
                   "only a tracker may begin it anew");
  check_changes(map, before);
}

void check_correction(const MapCorrection& correction, const SparseMap& map) {
  require_of_stage(correction.keyframe_id_end <= map.keyframe_id_end(),
                   "the correction is of a map with more key frames",
                   "keyframe_id_end is that of the map it was computed on");
  for (const MovedKeyFrame& moved : correction.moved) {
    check_id(moved.keyframe, map.keyframe_id_end(), "key frame");
    require_of_stage(moved.keyframe < correction.keyframe_id_end,
                     "the correction is of a map with " +
                         std::to_string(correction.keyframe_id_end) +
                         " key frames, but moves key frame " + std::to_string(moved.keyframe),
                     "set keyframe_id_end to that of the map it was computed on");
    require_of_stage(
        is_rigid_motion(moved.world_from_camera),
        "the new pose of key frame " + std::to_string(moved.keyframe) + " is no rigid motion",
        "it must be finite, with an orthonormal rotation");
  }
  for (const auto& [landmark, position] : correction.landmarks) {
    check_id(landmark, map.landmark_id_end(), "landmark");
    require_of_stage(is_near(position),
                     "the new position of landmark " + std::to_string(landmark) +
                         " is not finite, or beyond 10,000 km",
                     "leave out landmarks that were not optimised: they move with their key frame");
  }
  for (const auto& [kept, gone] : correction.fused) {
    check_id(kept, map.landmark_id_end(), "landmark");
    check_id(gone, map.landmark_id_end(), "landmark");
  }
}

void check_points(std::span<const LabelledPoint> points) {
  for (const LabelledPoint& point : points) {
    require_of_stage(point.position.allFinite(), "a point of the dense map is not finite",
                     "leave out cells without a position");
    require_of_stage(point.occupancy >= 0 && point.occupancy <= 1,
                     "a point of the dense map is occupied with a probability of " +
                         std::to_string(point.occupancy),
                     "it lies from 0 to 1; 1 where the map knows none");
  }
}

}  // namespace stillpoint
