#include "camera.hpp"

#include <algorithm>
#include <stillpoint/error.hpp>

namespace stillpoint_ros {
namespace {

using stillpoint::Error;
using stillpoint::Fault;

/// k1, k2, p1, p2[, k3]; of a rational polynomial only when its denominator is 1.
std::vector<double> distortion(const sensor_msgs::CameraInfo& info) {
  std::vector<double> all = info.D;
  while (!all.empty() && all.back() == 0.0) all.pop_back();
  if (all.empty()) return {};
  const bool fits =
      info.distortion_model == "plumb_bob" || info.distortion_model == "rational_polynomial";
  if (!fits || all.size() > 5)
    throw Error(Fault::kData,
                "the distortion '" + info.distortion_model + "' with " +
                    std::to_string(all.size()) + " coefficients is not modelled",
                "CameraInfo", "rectify the images with image_proc and set ~rectified");
  all.resize(std::max<std::size_t>(all.size(), 4));
  return all;
}

}  // namespace

SensorCamera camera_of(const sensor_msgs::CameraInfo& info, const Parameters& parameters) {
  const bool rectified = parameters.rectified;
  SensorCamera camera;
  camera.width = static_cast<int>(info.width);
  camera.height = static_cast<int>(info.height);
  camera.fx = rectified ? info.P[0] : info.K[0];
  camera.fy = rectified ? info.P[5] : info.K[4];
  camera.cx = rectified ? info.P[2] : info.K[2];
  camera.cy = rectified ? info.P[6] : info.K[5];
  if (!rectified) camera.distortion = distortion(info);
  camera.depth_factor = parameters.depth_factor;
  camera.min_depth = parameters.min_depth;
  camera.max_depth = parameters.max_depth;
  camera.depth_noise = parameters.depth_noise;
  camera.surface_noise = parameters.surface_noise;
  if (camera.fx == 0 || camera.fy == 0)
    throw Error(Fault::kData, "the camera is not calibrated: its focal length is 0", "CameraInfo",
                "calibrate it with camera_calibration");
  return camera;
}

}  // namespace stillpoint_ros
