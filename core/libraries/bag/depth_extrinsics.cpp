#include "bag/depth_extrinsics.hpp"

#include "bag/camera_model.hpp"
#include "bag/frame_tree.hpp"

namespace stillpoint::bag {

DepthExtrinsics depth_extrinsics(BagReader& bag, const TopicChoice& choice) {
  const std::string& color = choice.color.first.header.frame;
  const std::string& depth = choice.depth.first.header.frame;
  try {
    return {.camera = camera_in_bag(bag, choice.depth),
            .color_from_depth = FrameTree(bag).target_from_source(color, depth)};
  } catch (const Error& error) {
    throw Error(error.fault(),
                "depth of " + choice.depth.name + " is in the frame '" + depth + "', colour of " +
                    choice.color.name + " in '" + color +
                    "', and cannot be registered to the colour images: " + error.what(),
                "",
                "record registered depth (align_depth, depth_registered) or /tf_static and the "
                "depth camera's CameraInfo as well; if depth is registered, set "
                "source.registered=true");
  }
}

}  // namespace stillpoint::bag
