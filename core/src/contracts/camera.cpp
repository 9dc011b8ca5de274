#include "stillpoint/contracts/camera.hpp"

namespace stillpoint {

void CameraModel::visit(OptionVisitor& v) {
  v("name", name, {.help = "for messages and summaries"});
  v("width", width,
    {.min = 16, .max = 16384, .unit = "px", .help = "width of the recorded images"});
  v("height", height,
    {.min = 16, .max = 16384, .unit = "px", .help = "height of the recorded images"});
  v("fx", fx,
    {.min = 1, .max = 1e6, .unit = "px", .help = "focal length along x", .required = true});
  v("fy", fy,
    {.min = 1, .max = 1e6, .unit = "px", .help = "focal length along y", .required = true});
  v("cx", cx,
    {.min = -1e6,
     .max = 1e6,
     .unit = "px",
     .help = "principal point, from the centre of the left column",
     .required = true});
  v("cy", cy,
    {.min = -1e6,
     .max = 1e6,
     .unit = "px",
     .help = "principal point, from the centre of the top row",
     .required = true});
  v("distortion", distortion,
    {.min = -1e6, .max = 1e6, .help = "Brown–Conrady k1, k2, p1, p2[, k3]; empty for none"});
  v("depth_factor", depth_factor,
    {.min = 1e-6,
     .max = 1e9,
     .help = "depth image value of one metre: 1000 for millimetres, 5000 in the format of TUM"});
  v("min_depth", min_depth,
    {.min = 0, .max = 1e6, .unit = "m", .help = "nearer measurements are dropped"});
  v("max_depth", max_depth,
    {.min = 0.01, .max = 1e6, .unit = "m", .help = "farther ones are dropped"});
  v("depth_noise", depth_noise,
    {.min = 1e-6,
     .max = 100,
     .unit = "m",
     .help = "standard deviation of a point feature's depth at 1 m, with errors of registration "
             "and timing; grows with the square of the depth"});
  v("surface_noise", surface_noise,
    {.min = 1e-6,
     .max = 100,
     .unit = "m",
     .help = "standard deviation of depth on a smooth surface at 1 m; grows with the square of the "
             "depth"});
  v("crop", crop, {.unit = "px", .help = "x, y, width, height of the part to use; empty for all"});
  v.require(distortion.empty() || distortion.size() == 4 || distortion.size() == 5,
            "distortion takes 4 or 5 numbers: k1, k2, p1, p2[, k3]");
  v.require(min_depth < max_depth, "min_depth must be smaller than max_depth");
  v.require(
      crop.empty() || (crop.size() == 4 && crop[0] >= 0 && crop[1] >= 0 && crop[2] >= 16 &&
                       crop[3] >= 16 && crop[0] + crop[2] <= width && crop[1] + crop[3] <= height),
      "crop takes x, y, width, height within the image, at least 16 x 16");
}

Camera CameraModel::undistorted() const {
  Camera camera{.width = width,
                .height = height,
                .fx = fx,
                .fy = fy,
                .cx = cx,
                .cy = cy,
                .depth_noise = depth_noise,
                .surface_noise = surface_noise};
  if (crop.size() == 4) {
    camera.cx -= crop[0];
    camera.cy -= crop[1];
    camera.width = static_cast<int>(crop[2]);
    camera.height = static_cast<int>(crop[3]);
  }
  return camera;
}

}  // namespace stillpoint
