// Where the depth camera is, of depth images that are not registered to the colour images.
#pragma once

#include "bag/topic_choice.hpp"
#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::bag {

struct DepthExtrinsics {
  CameraModel camera;  ///< of the depth images
  Pose color_from_depth = Pose::Identity();
};

/// By their CameraInfo, and by tf between their frame and that of the colour images, or by what a
/// recording of the RealSense SDK has in place of tf. Throws Error(kUsage), which says that depth
/// is not registered, when the bag lacks either.
DepthExtrinsics depth_extrinsics(BagReader& bag, const TopicChoice& choice);

}  // namespace stillpoint::bag
