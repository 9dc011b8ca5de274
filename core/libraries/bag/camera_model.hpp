// The camera of a CameraInfo message.
#pragma once

#include "bag/messages.hpp"
#include "bag/topic_choice.hpp"
#include "stillpoint/contracts/camera.hpp"

namespace stillpoint::bag {

/// `rectified`: the images are rectified already, so that P describes them; otherwise K and the
/// distortion. Depth is in millimetres, as ROS has it (REP 118). `name` becomes that of the camera.
/// Throws Error(kData) when the camera is not calibrated, or its distortion is none that
/// CameraModel has.
CameraModel camera_model(const CameraInfoMessage& info, bool rectified, const std::string& name);

/// That of the images' first CameraInfo that can be read. Throws Error(kUsage) when the bag has
/// none.
CameraModel camera_in_bag(BagReader& bag, const ImageTopic& images);

}  // namespace stillpoint::bag
