#include "orb_slam/orb_keyframe.hpp"

#include <string>

#include "orb_slam/scale_pyramid.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::orb_slam {

namespace {

[[noreturn]] void refuse(const KeyFrame& keyframe, const std::string& features) {
  throw Error(Fault::kStage,
              "key frame " + std::to_string(keyframe.id) + " has features " + features, "",
              "take tracker and local mapper of one plugin, and maps that they have made");
}

}  // namespace

void require_orb(const KeyFrame& keyframe) {
  const Features& features = *keyframe.features;
  if (features.descriptors.size() != features.size()) refuse(keyframe, "without ORB descriptors");
  if (features.levels < 1 || features.levels > ScalePyramid::kMaxLevels)
    refuse(keyframe, "of " + std::to_string(features.levels) + " pyramid levels, not of 1 to " +
                         std::to_string(ScalePyramid::kMaxLevels));
  if (!(features.scale_factor > 1)) refuse(keyframe, "of pyramid levels of one size");
}

void require_orb(const SparseMap& map) {
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    if (const KeyFrame* keyframe = map.keyframe(id)) require_orb(*keyframe);
}

}  // namespace stillpoint::orb_slam
