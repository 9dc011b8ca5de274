// The image panel of one frame, and the surface that a key frame has seen.
#pragma once

#include <memory>
#include <stillpoint/sdk.hpp>
#include <string>

namespace stillpoint::output_web {

/// Records of the image (JPEG), its features with the reason why tracking does not use them, moving
/// points and mask.
std::string picture_of(const FrameReport& report);

/// The record of the surface: depth, colour and class on a grid of pixels, without what the
/// decision keeps out of the map. Pixels are unprojected by the viewer, with the key frame's pose
/// of then.
std::string cloud_of(const FrameReport& report, KeyFrameId keyframe);

}  // namespace stillpoint::output_web
