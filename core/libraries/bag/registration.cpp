#include "bag/registration.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::bag {
namespace {

// Of the width. Drivers may give a calibration for one topic and their defaults for the other: of a
// Kinect, these are up to 1.6 % apart, and its infrared camera is 5 % off or more.
constexpr double kSameCamera = 0.03;

bool is_calibrated(const CameraInfoMessage& camera) { return camera.intrinsics[0] != 0.0; }

bool cameras_differ(const CameraInfoMessage& a, const CameraInfoMessage& b) {
  if (!is_calibrated(a) || !is_calibrated(b)) return false;
  if (a.width != b.width || a.height != b.height) return true;
  const auto same = [&](double of_a, double of_b) {
    return std::abs(of_a - of_b) <= kSameCamera * a.width;
  };
  return !std::ranges::equal(a.intrinsics, b.intrinsics, same);
}

}  // namespace

bool says_registered(const std::string& topic) {
  return topic.find("registered") != std::string::npos ||
         topic.find("aligned") != std::string::npos;
}

bool names_camera(const std::string& frame) {
  return !std::ranges::all_of(frame, [](char letter) { return letter >= '0' && letter <= '9'; });
}

bool is_registered(const ImageOrigin& color, const ImageOrigin& depth) {
  if (says_registered(depth.topic)) return true;
  if (color.frame != depth.frame || !names_camera(color.frame)) return false;
  return !color.camera || !depth.camera || !cameras_differ(*color.camera, *depth.camera);
}

}  // namespace stillpoint::bag
