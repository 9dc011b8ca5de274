// What a perfect camera sees: colours with motion blur and smooth edges, exact depth and labels.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "simulation/camera_motion.hpp"
#include "simulation/ray_caster.hpp"
#include "stillpoint/contracts/camera.hpp"

namespace stillpoint::simulation {

struct View {
  cv::Mat color;      ///< CV_32FC3, BGR, 0…255 at normal exposure; empty if not wanted
  cv::Mat depth;      ///< CV_32FC1, metres along z, 0 = nothing there
  cv::Mat infrared;   ///< CV_32FC1, share of the depth sensor's light that comes back
  cv::Mat labels;     ///< CV_8UC1, PASCAL VOC
  cv::Mat instances;  ///< CV_8UC1
};

class Renderer {
 public:
  /// `world` and `motion` must outlive the renderer.
  Renderer(const World& world, const CameraMotion& motion, const Camera& camera, int threads);

  /// Geometry and labels are those in the middle of the exposure. Times in seconds from the first
  /// frame.
  View render(double time, double exposure);
  /// Without colours.
  View render_geometry(double time);

  int threads() const { return threads_; }

 private:
  struct Job;

  const World& world_;
  const CameraMotion& motion_;
  Camera camera_;
  int threads_;
  RayCaster caster_;
  std::vector<Eigen::AlignedBox3f> boxes_;  // of the bodies, each in its own frame
};

}  // namespace stillpoint::simulation
