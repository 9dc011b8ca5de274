// Whether depth images are registered: seen from the colour camera.
#pragma once

#include <optional>
#include <string>

#include "bag/messages.hpp"

namespace stillpoint::bag {

/// What messages say of where images were taken from.
struct ImageOrigin {
  std::string topic;
  std::string frame;
  std::optional<CameraInfoMessage> camera = {};  ///< nothing: it is not known
};

/// By the name of a depth topic ("registered", "aligned").
bool says_registered(const std::string& topic);

/// False for what drivers write that know no frames: nothing, or "0" for all their cameras.
bool names_camera(const std::string& frame);

/// By the name of the depth topic, or because both have the frame of one camera and the cameras of
/// both, where they are known, do not differ in size or K.
bool is_registered(const ImageOrigin& color, const ImageOrigin& depth);

}  // namespace stillpoint::bag
