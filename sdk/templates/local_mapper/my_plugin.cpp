#include "my_plugin.hpp"

#include <cmath>
#include <utility>

namespace plugins::my_plugin {
namespace {

/// What tracking has learnt about landmarks since the last key frame.
void add_evidence(stillpoint::MapEdit& edit,
                  const std::vector<stillpoint::LandmarkEvidence>& evidence) {
  for (const stillpoint::LandmarkEvidence& e : evidence) {
    const stillpoint::LandmarkId id = edit.map().current_id(e.landmark);
    if (id == stillpoint::kNoId) continue;
    stillpoint::Landmark& landmark = edit.landmark(id);
    landmark.visible += e.visible;
    landmark.found += e.found;
    landmark.static_log_odds += e.static_log_odds;
  }
}

}  // namespace

stillpoint::SparseMap MyPlugin::insert(stillpoint::SparseMap map, stillpoint::KeyFrame keyframe) {
  stillpoint::MapEdit edit(std::move(map));
  const stillpoint::KeyFrameId id = keyframe.id;
  add_evidence(edit, std::exchange(keyframe.evidence, {}));
  edit.add_keyframe(std::move(keyframe));
  add_landmarks(edit, id);
  edit.update_covisibility(id);
  return std::move(edit).finish();
}

/// One for each feature with depth that has none yet and stands still.
void MyPlugin::add_landmarks(stillpoint::MapEdit& edit, stillpoint::KeyFrameId id) {
  const auto keyframe = edit.map().shared_keyframe(id);  // edits make a new one
  const stillpoint::Features& features = *keyframe->features;
  const Eigen::Vector3d eye = keyframe->world_from_camera.translation();
  for (std::uint32_t i = 0; i < features.size(); ++i) {
    const float depth = features.depth[i];
    if (keyframe->landmarks[i] != stillpoint::kNoId || !(depth > 0) || depth > options_.max_depth ||
        keyframe->track_weights[i] == 0 || keyframe->map_weights[i] == 0)
      continue;
    const cv::KeyPoint& keypoint = features.keypoints[i];
    const Eigen::Vector3d position =
        keyframe->world_from_camera *
        keyframe->camera->unproject(keypoint.pt.x, keypoint.pt.y, depth);
    stillpoint::Landmark landmark{.position_in_world = position, .created_by = id};
    landmark.mean_view = (position - eye).normalized();
    if (!features.descriptors.empty()) landmark.descriptor = features.descriptors[i];
    // Seen on this level of the pyramid; from other distances it is on another one.
    const double distance = (position - eye).norm();
    const double largest = distance * std::pow(features.scale_factor, keypoint.octave);
    landmark.max_distance = static_cast<float>(largest);
    landmark.min_distance =
        static_cast<float>(largest / std::pow(features.scale_factor, features.levels - 1));
    const stillpoint::LandmarkId added = edit.add_landmark(std::move(landmark));
    edit.add_observation(added, {id, i});
    recent_.push_back(added);
  }
}

stillpoint::SparseMap MyPlugin::refine(stillpoint::SparseMap map, stillpoint::KeyFrameId id,
                                       std::stop_token end_early) {
  stillpoint::MapEdit edit(std::move(map));
  std::vector<stillpoint::LandmarkId> still_recent;
  for (const stillpoint::LandmarkId candidate : recent_) {
    const stillpoint::Landmark* landmark = edit.map().landmark(candidate);
    if (!landmark) continue;
    const bool young = landmark->created_by + static_cast<unsigned>(options_.probation) > id;
    const bool bad = landmark->found < options_.min_found_share * landmark->visible;
    // Another key frame waits: what is not looked at now is looked at next time.
    if (bad && !end_early.stop_requested())
      edit.remove_landmark(candidate);
    else if (young || bad)
      still_recent.push_back(candidate);
  }
  recent_ = std::move(still_recent);
  if (edit.map().keyframe(id)) edit.update_covisibility(id);
  return std::move(edit).finish();
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::LocalMapper, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "landmarks from depth, culled when they are not found again"));
