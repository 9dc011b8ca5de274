#include "bag/depth_extrinsics.hpp"

#include "bag/camera_model.hpp"
#include "bag/frame_tree.hpp"
#include "bag/realsense_recording.hpp"
#include "bag/registration.hpp"

namespace stillpoint::bag {
namespace {

Pose color_from_depth(BagReader& bag, const TopicChoice& choice) {
  if (const auto pose = realsense_color_from_depth(bag, choice.color.name, choice.depth.name))
    return *pose;
  const std::string& color = choice.color.first.header.frame;
  const std::string& depth = choice.depth.first.header.frame;
  for (const std::string& frame : {color, depth})
    if (!names_camera(frame))
      throw Error(Fault::kUsage, "the frame '" + frame + "' does not say where a camera is");
  if (color == depth)
    throw Error(Fault::kUsage,
                "both have the same frame, but their CameraInfo are of different cameras");
  return FrameTree(bag).target_from_source(color, depth);
}

[[noreturn]] void refuse_depth(const TopicChoice& choice, const Error& reason) {
  if (!realsense_stream(choice.depth.name).empty())
    throw Error(reason.fault(),
                std::string("this is a recording of the RealSense SDK, whose depth is not "
                            "registered, and cannot be registered to the colour images: ") +
                    reason.what(),
                "",
                "play it with the node realsense2_camera (rosbag_filename, align_depth) and record "
                "the topics of that; if its depth was aligned, set source.registered=true");
  throw Error(reason.fault(),
              "depth of " + choice.depth.name + " is in the frame '" +
                  choice.depth.first.header.frame + "', colour of " + choice.color.name + " in '" +
                  choice.color.first.header.frame +
                  "', and cannot be registered to the colour images: " + reason.what(),
              "",
              "record registered depth (align_depth, depth_registered) or /tf_static and the depth "
              "camera's CameraInfo as well; if depth is registered, set source.registered=true");
}

}  // namespace

DepthExtrinsics depth_extrinsics(BagReader& bag, const TopicChoice& choice) {
  try {
    return {.camera = camera_in_bag(bag, choice.depth),
            .color_from_depth = color_from_depth(bag, choice)};
  } catch (const Error& error) {
    refuse_depth(choice, error);
  }
}

}  // namespace stillpoint::bag
