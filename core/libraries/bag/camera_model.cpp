#include "bag/camera_model.hpp"

#include <algorithm>

#include "stillpoint/support/option_check.hpp"

namespace stillpoint::bag {
namespace {

constexpr double kMillimetres = 1000.0;  // of depth images with 16 bits

/// k1, k2, p1, p2[, k3]; a rational polynomial only when its denominator is 1.
std::vector<double> brown_conrady(const CameraInfoMessage& info) {
  std::vector<double> all = info.distortion;
  while (!all.empty() && all.back() == 0.0) all.pop_back();
  if (all.empty()) return {};
  const bool fits = info.model == "plumb_bob" || info.model == "rational_polynomial";
  if (!fits || all.size() > 5)
    throw Error(Fault::kData,
                "the distortion '" + info.model + "' with " + std::to_string(all.size()) +
                    " coefficients is none that a camera can have",
                "", "record rectified images, or rectify them with image_proc");
  all.resize(std::max<std::size_t>(all.size(), 4));
  return all;
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
  std::optional<CameraInfoMessage> info;
  for (const MessagePlace& place : bag.messages()) {
    if (place.topic != images.info) continue;
    try {
      info = read_camera_info(bag.read(place), bag.topics()[place.topic].serialisation);
      break;
    } catch (const Error&) {  // a damaged one; the next may do
    }
  }
  if (info) return camera_model(*info, images.rectified(), bag.topics()[*images.info].name);
  const bool depth = images.first.kind() == ImageKind::kDepth;
  throw Error(Fault::kUsage, "the bag has no CameraInfo of " + images.name, "",
              std::string("name its topic with --set source.") +
                  (depth ? "depth_info_topic=NAME" : "info_topic=NAME, or a camera with --camera"));
}

}  // namespace stillpoint::bag
