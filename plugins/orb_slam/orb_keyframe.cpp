#include "orb_slam/orb_keyframe.hpp"

#include <string>

#include "orb_slam/scale_pyramid.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::orb_slam {

void require_orb(const KeyFrame& keyframe) {
  const Features& features = *keyframe.features;
  if (features.size() == 0) return;
  if (features.descriptors.size() != features.size())
    throw Error(
        Fault::kStage,
        "key frame " + std::to_string(keyframe.id) + " has features without ORB descriptors", "",
        "take tracker and local mapper of one plugin, and maps that they have made");
  const ScalePyramid pyramid(features);
}

void require_orb(const SparseMap& map) {
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    if (const KeyFrame* keyframe = map.keyframe(id)) require_orb(*keyframe);
}

}  // namespace stillpoint::orb_slam
