#include "bag/camera_model.hpp"

#include <algorithm>
#include <sstream>

#include "bag/realsense_recording.hpp"
#include "stillpoint/support/option_check.hpp"

namespace stillpoint::bag {
namespace {

constexpr double kMillimetres = 1000.0;  // of depth images with 16 bits

/// k1, k2, p1, p2[, k3]; a rational polynomial only when its denominator is 1.
std::vector<double> brown_conrady(const CameraInfoMessage& info) {
  std::vector<double> all = info.distortion;
  while (!all.empty() && all.back() == 0.0) all.pop_back();
  if (all.empty()) return {};
  // The RealSense SDK writes "Inverse Brown Conrady" and the like, and projects by the same
  // formula; its node for ROS calls them plumb_bob.
  const bool fits = info.model == "plumb_bob" || info.model == "rational_polynomial" ||
                    info.model.ends_with("Brown Conrady");
  if (!fits || all.size() > 5)
    throw Error(Fault::kData,
                "the distortion '" + info.model + "' with " + std::to_string(all.size()) +
                    " coefficients is none that a camera can have",
                "", "record rectified images, or rectify them with image_proc");
  all.resize(std::max<std::size_t>(all.size(), 4));
  return all;
}

std::string number_text(double number) {
  std::ostringstream text;
  text.precision(9);
  text << number;
  return text.str();
}

}  // namespace

CameraModel camera_model(const CameraInfoMessage& info, bool rectified, const std::string& name) {
  const auto& k = info.intrinsics;
  const auto& p = info.projection;
  CameraModel model{.name = name,
                    .width = info.width,
                    .height = info.height,
                    .fx = rectified ? p[0] : k[0],
                    .fy = rectified ? p[5] : k[4],
                    .cx = rectified ? p[2] : k[2],
                    .cy = rectified ? p[6] : k[5],
                    .depth_factor = kMillimetres};
  if (model.fx == 0.0 && model.fy == 0.0)
    throw Error(Fault::kData, "the camera is not calibrated: its focal lengths are 0", name,
                "give a calibrated one with --camera");
  if (!rectified) model.distortion = brown_conrady(info);
  try {
    check_options(model, "the CameraInfo");
  } catch (const Error& error) {
    throw Error(Fault::kData, error.what(), name, "give a sound one with --camera");
  }
  return model;
}

CameraModel camera_in_bag(BagReader& bag, const ImageTopic& images) {
  if (images.camera)
    return camera_model(*images.camera, images.rectified(), bag.topics()[*images.info].name);
  const bool depth = images.first.kind() == ImageKind::kDepth;
  throw Error(Fault::kUsage, "the bag has no CameraInfo of " + images.name, "",
              "name its topic: " + how_to_name(depth ? "depth_info_topic" : "info_topic") +
                  (depth ? "" : "; or give a camera with --camera"));
}

CameraModel rectified_camera(const TopicChoice& choice, const CameraModel& color) {
  for (const ImageTopic* images : {&choice.depth, &choice.color}) {
    const auto& info = images->camera;
    if (info && info->projection[0] != 0.0 && info->width == color.width &&
        info->height == color.height)
      return camera_model(*info, true, color.name);
  }
  CameraModel rectified = color;
  rectified.distortion.clear();
  rectified.crop.clear();
  return rectified;
}

double depth_factor_in_bag(BagReader& bag, const ImageTopic& depth) {
  return realsense_depth_factor(bag, depth.name).value_or(kMillimetres);
}

std::string depth_factor_warning(const CameraModel& camera_file, double of_images) {
  if (camera_file.depth_factor == of_images) return {};
  const std::string unit = of_images == kMillimetres
                               ? "of ROS is in millimetres"
                               : "of this recording has " + number_text(of_images) + " for a metre";
  return "16-bit depth " + unit + ", but the camera file has depth_factor " +
         number_text(camera_file.depth_factor) + ": set it to " + number_text(of_images) +
         ", or source.depth_factor if these images differ";
}

}  // namespace stillpoint::bag
