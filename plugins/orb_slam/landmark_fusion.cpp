#include "orb_slam/landmark_fusion.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/matcher.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr double kFusionWindow = 3.0;  // px at the predicted level

/// Observations of both landmarks that are inliers to the position of `landmark`.
std::ptrdiff_t inlier_count(const SparseMap& map, const Landmark& landmark, const Landmark& other) {
  const auto fits = [&](const Observation& o) {
    return observation_fits(map, landmark.position_in_world, o);
  };
  return std::ranges::count_if(landmark.observations, fits) +
         std::ranges::count_if(other.observations, fits);
}

/// Keeps the landmark with more inlier observations: a wrong triangulation fits only the
/// observations that it was made from, and others fused into it would distort key frame poses.
void fuse_pair(MapEdit& edit, LandmarkId a, LandmarkId b) {
  const Landmark &first = *edit.map().landmark(a), &second = *edit.map().landmark(b);
  const bool keep_a =
      std::pair(inlier_count(edit.map(), first, second), first.observations.size()) >=
      std::pair(inlier_count(edit.map(), second, first), second.observations.size());
  const LandmarkId kept = keep_a ? a : b;
  edit.fuse_landmarks(kept, keep_a ? b : a);
  remove_outlier_observations(edit, kept);
  refresh_landmark(edit, kept);
}

void fuse_into(MapEdit& edit, const std::vector<LandmarkId>& landmarks, KeyFrameId target) {
  const std::shared_ptr<const KeyFrame> keyframe = edit.map().shared_keyframe(target);
  const Pose camera_from_world = keyframe->world_from_camera.inverse();
  const ScalePyramid pyramid(*keyframe->features);
  std::vector<bool> seen(edit.map().landmark_id_end());
  for (const LandmarkId id : keyframe->landmarks)
    if (id != kNoId) seen[id] = true;

  std::vector<Query> queries;
  for (const LandmarkId id : landmarks) {
    const Landmark* landmark = edit.map().landmark(id);
    if (!landmark || seen[id]) continue;
    const auto query =
        predict(*landmark, camera_from_world, *keyframe->camera, pyramid, kFusionWindow);
    if (query) queries.push_back(*query);
  }
  if (queries.empty()) return;
  const FeatureGrid grid(*keyframe->features, *keyframe->camera);
  const auto usable = [&](std::uint32_t i) { return keyframe->track_weights[i] >= kMinMapWeight; };
  for (const Match& m :
       match_near(queries, *keyframe->features, grid, usable, {.max_distance = kStrictDistance})) {
    const Landmark* landmark = edit.map().landmark(m.id);
    if (!landmark ||
        !observation_error(landmark->position_in_world, camera_from_world, *keyframe, m.feature)
             .fits())
      continue;
    const LandmarkId there = edit.map().keyframe(target)->landmarks[m.feature];
    if (there == kNoId) {
      if (edit.add_observation(m.id, {target, m.feature})) refresh_landmark(edit, m.id);
    } else if (there != m.id) {
      fuse_pair(edit, m.id, there);
    }
  }
}

std::vector<LandmarkId> landmarks_of(const SparseMap& map, KeyFrameId id) {
  std::vector<LandmarkId> landmarks = map.keyframe(id)->landmarks;
  std::erase(landmarks, kNoId);
  return landmarks;
}

}  // namespace

void fuse_with_neighbours(MapEdit& edit, KeyFrameId id, int neighbours) {
  std::vector<Covisibility> covisible = edit.map().keyframe(id)->covisible;
  if (static_cast<int>(covisible.size()) > neighbours) covisible.resize(neighbours);
  for (const Covisibility& c : covisible) fuse_into(edit, landmarks_of(edit.map(), id), c.keyframe);

  std::vector<LandmarkId> theirs;
  for (const Covisibility& c : covisible) {
    const std::vector<LandmarkId> landmarks = landmarks_of(edit.map(), c.keyframe);
    theirs.insert(theirs.end(), landmarks.begin(), landmarks.end());
  }
  std::sort(theirs.begin(), theirs.end());
  theirs.erase(std::unique(theirs.begin(), theirs.end()), theirs.end());
  fuse_into(edit, theirs, id);
}

}  // namespace stillpoint::orb_slam
