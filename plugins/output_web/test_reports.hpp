// Reports and maps for tests.
#pragma once

#include <cstddef>
#include <memory>
#include <stillpoint/sdk.hpp>
#include <stillpoint/testing/test_recording.hpp>
#include <utility>

namespace stillpoint::output_web {

inline KeyFrame keyframe_at(KeyFrameId id, double x) {
  KeyFrame keyframe{.id = id, .frame = 10 * id};
  keyframe.world_from_camera.translation().x() = x;
  keyframe.features = std::make_shared<const Features>(
      Features{.keypoints = {{}}, .descriptors = {{}}, .depth = {1}});
  keyframe.track_weights = keyframe.map_weights = {255};
  keyframe.landmarks = {kNoId};
  return keyframe;
}

inline SparseMap map_of_three() {
  MapEdit edit({});
  for (KeyFrameId id = 0; id < 3; ++id) edit.add_keyframe(keyframe_at(id, id));
  const LandmarkId landmark =
      edit.add_landmark({.position_in_world = {1, 2, 3}, .reference = 0, .static_log_odds = -1});
  for (KeyFrameId id = 0; id < 3; ++id) edit.add_observation(landmark, {id, 0});
  edit.add_landmark({.position_in_world = {4, 5, 6}, .reference = 0});
  for (KeyFrameId id = 0; id < 3; ++id) edit.update_covisibility(id, 1);
  return std::move(edit).finish();
}

inline const testing::TestRecording& recording() {
  static const testing::TestRecording kRecording({.frames = 4});
  return kRecording;
}

inline FrameReport report_of(std::size_t i) {
  FrameReport report{.frame = recording().frame(i),
                     .segmentation = recording().segmentation(i),
                     .moving = recording().moving_points(i),
                     .weights = recording().weights(i),
                     .times = {{"track", 5, 4, static_cast<std::uint32_t>(i)}},
                     .map = std::make_shared<const SparseMap>(),
                     .left_out = 2 * i};
  report.result.state = TrackState::kTracking;
  report.result.reference = 0;
  report.result.world_from_camera = recording().world_from_camera(i);
  report.result.reference_from_camera = recording().world_from_camera(i);
  report.result.features = 1000;
  report.result.inliers = 400;
  report.result.tracked = {{{20.5f, 10.f}, TrackedFeature::Use::kInlier}};
  if (i == 0) report.result.keyframe = recording().keyframe(0, 0);
  return report;
}

}  // namespace stillpoint::output_web
