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

/// Of depth images that are registered to colour images of the camera `color`, and rectified, which
/// the colour images are not: as P of a CameraInfo has it, or else `color` without distortion.
CameraModel rectified_camera(const TopicChoice& choice, const CameraModel& color);

/// Of 16-bit depth images, the value of one metre: 1000, as ROS has it, or what a recording of the
/// RealSense SDK says.
double depth_factor_in_bag(BagReader& bag, const ImageTopic& depth);

/// Empty when a camera file has the depth factor of the 16-bit images; otherwise that it has not.
std::string depth_factor_warning(const CameraModel& camera_file, double of_images = 1000.0);

}  // namespace stillpoint::bag
