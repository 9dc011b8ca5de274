// A recording made on demand: the frames of a scene, one by one, with the truth about them.
#pragma once

#include <memory>

#include "simulation/renderer.hpp"
#include "simulation/sensor.hpp"
#include "simulation/world.hpp"

namespace stillpoint::simulation {

struct SimulatedFrame {
  int index = 0;          ///< from 0
  double time = 0;        ///< s, of the colour image: middle of its exposure, whole microseconds
  double depth_time = 0;  ///< s, of the depth image
  Pose world_from_camera = Pose::Identity();  ///< at `time`
  cv::Mat bgr;                                ///< CV_8UC3
  cv::Mat depth;                              ///< CV_16UC1, 0 = no measurement
  cv::Mat labels;                             ///< CV_8UC1, PASCAL VOC, of the colour image
  cv::Mat instances;                          ///< CV_8UC1, of the colour image, 0 = none
};

/// Two simulators of the same options give the same bytes, whatever their number of threads and
/// whichever frames are asked for. Where the scene does not fit into memory, constructors and
/// frame() throw Error(kStage).
class Simulator {
 public:
  /// Throws Error(kUsage) when the camera is not a plain pinhole camera.
  Simulator(const SceneOptions& scene, const CameraModel& camera, int threads);
  /// Shares the world, so that several threads can render frames of their own of one recording.
  Simulator(const Simulator& other);

  SimulatedFrame frame(int index);

  int size() const { return scene_.frames; }
  const SceneOptions& scene() const { return scene_; }
  const CameraModel& camera() const { return camera_; }
  double stamp(int index) const;
  double depth_stamp(int index) const;
  Pose world_from_camera(double stamp) const;

 private:
  SceneOptions scene_;
  CameraModel camera_;
  std::shared_ptr<const World> world_;
  CameraMotion motion_;
  Renderer renderer_;
  Sensor sensor_;
};

/// The camera of scenes that name none: that of the fr3 sequences.
CameraModel default_camera();

}  // namespace stillpoint::simulation
