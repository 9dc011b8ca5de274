#include "plugin_check/map_making.hpp"

#include <memory>
#include <utility>

#include "stillpoint/runtime/null_stages.hpp"

namespace stillpoint::plugin_check {

SparseMap inserted(SparseMap map, KeyFrame keyframe) {
  return make_null_stage<LocalMapper>()->insert(std::move(map), std::move(keyframe));
}

SparseMap with_large_ids(SparseMap map, KeyFrameId count) {
  const auto nothing = std::make_shared<const Features>();
  MapEdit edit(std::move(map));
  for (KeyFrameId i = 0; i < count; ++i) {
    const auto id = static_cast<KeyFrameId>(edit.map().keyframe_id_end());
    KeyFrame keyframe{.id = id};
    keyframe.features = nothing;
    edit.add_keyframe(std::move(keyframe));
    edit.keyframe(id).parent = 0;  // update_covisibility() would look through all that are gone
    edit.remove_keyframe(id);
    edit.remove_landmark(edit.add_landmark({}));
  }
  return std::move(edit).finish();
}

SparseMap saved_map(const Scenario& scenario) {
  if (scenario.first_keyframe == 0) return {};
  return with_large_ids(inserted({}, scenario.keyframe(0, 0)), scenario.first_keyframe - 1);
}

void saw(Observer& observer, const SparseMap& map) {
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    observer.saw(map.world_from_keyframe(id));
  for (LandmarkId id = 0; id < map.landmark_id_end(); ++id)
    if (const Landmark* landmark = map.landmark(id)) observer.saw(landmark->position_in_world);
}

std::stop_token requested_stop() {
  std::stop_source source;
  source.request_stop();
  return source.get_token();
}

}  // namespace stillpoint::plugin_check
