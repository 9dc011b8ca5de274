// The pinhole camera every stage sees, and the raw sensor a source turns into it.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "stillpoint/export.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint {

/// An undistorted pinhole camera with registered depth. Camera frame: x right, y down, z forward,
/// metres. Pixel (0, 0) is the centre of the top left pixel.
struct STILLPOINT_EXPORT Camera {
  int width = 640;    ///< px
  int height = 480;   ///< px
  double fx = 525.0;  ///< px
  double fy = 525.0;  ///< px
  double cx = 319.5;  ///< px
  double cy = 239.5;  ///< px
  /// Standard deviations of depth at 1 m, in metres. For a structured-light sensor they grow with
  /// the square of the distance; that of the inverse depth is then constant, in 1/m (Khoshelham and
  /// Elberink, Sensors 2012). `surface_noise` is that of the sensor alone, on a smooth surface.
  /// `depth_noise` is that of a point feature in a recording: it includes depth edges, registration
  /// errors, and the time offset between colour and depth images.
  double depth_noise = 0.02;
  double surface_noise = 0.002;

  /// Pixel of a point in the camera frame; z must be positive.
  Eigen::Vector2d project(const Eigen::Vector3d& point_in_camera) const {
    return {fx * point_in_camera.x() / point_in_camera.z() + cx,
            fy * point_in_camera.y() / point_in_camera.z() + cy};
  }
  /// Point in the camera frame of a pixel with depth `z` in metres.
  Eigen::Vector3d unproject(double u, double v, double z) const {
    return {(u - cx) / fx * z, (v - cy) / fy * z, z};
  }
  /// Derivative of what is measured of a point, (u, v, 1 / z), by the point in the camera frame.
  Eigen::Matrix3d measurement_jacobian(const Eigen::Vector3d& point_in_camera) const {
    const Eigen::Vector3d& p = point_in_camera;
    const double iz = 1.0 / p.z();
    Eigen::Matrix3d jacobian;
    jacobian << fx * iz, 0, -fx * p.x() * iz * iz,  //
        0, fy * iz, -fy * p.y() * iz * iz,          //
        0, 0, -iz * iz;
    return jacobian;
  }
  /// Whether a pixel position lies in the image, `border` pixels away from its edges.
  bool contains(double u, double v, double border = 0.0) const {
    return u >= border && v >= border && u <= width - 1 - border && v <= height - 1 - border;
  }
};

/// A sensor as it records: the `camera:` section of a pipeline file and the files in
/// configs/cameras. Sources undistort and crop with it.
struct STILLPOINT_EXPORT CameraModel {
  std::string name = "camera";
  int width = 640;    ///< px, of the recorded images
  int height = 480;   ///< px
  double fx = 525.0;  ///< px
  double fy = 525.0;  ///< px
  double cx = 319.5;  ///< px
  double cy = 239.5;  ///< px
  /// Brown–Conrady k1, k2, p1, p2[, k3]; empty or all zero: none.
  std::vector<double> distortion;
  double depth_factor = 5000.0;  ///< depth image value of one metre
  double min_depth = 0.3;        ///< metres; nearer measurements are dropped
  double max_depth = 10.0;       ///< metres; farther measurements are dropped
  double depth_noise = 0.02;     ///< metres at 1 m, see Camera
  double surface_noise = 0.002;  ///< metres at 1 m, see Camera
  /// x, y, width, height in px of the part of the undistorted image that is used; empty: all of it.
  std::vector<double> crop;

  void visit(OptionVisitor& visitor);

  /// The camera of the undistorted and cropped image: same focal lengths, shifted centre.
  Camera undistorted() const;
};

}  // namespace stillpoint
