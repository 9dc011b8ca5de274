// Recordings of the RealSense SDK (realsense-viewer, rs-record): bags of ROS 1 whose topics and
// frames are not those of its node for ROS, and whose depth is not registered.
#pragma once

#include <optional>
#include <string>

#include "bag/bag_reader.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::bag {

/// "/device_0/sensor_1/Color_0" of the images "/device_0/sensor_1/Color_0/image/data"; empty: these
/// are of another recorder.
std::string realsense_stream(const std::string& images);

/// Between the cameras of two topics of images, by the transform of each to one stream of the
/// device; nothing when the recording has none of either.
std::optional<Pose> realsense_color_from_depth(BagReader& bag, const std::string& color,
                                               const std::string& depth);

/// Of a topic of depth images, the value of one metre; nothing when the recording does not say it.
std::optional<double> realsense_depth_factor(BagReader& bag, const std::string& depth);

}  // namespace stillpoint::bag
