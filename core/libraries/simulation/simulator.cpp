#include "simulation/simulator.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/out_of_memory.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::simulation {
namespace {

/// As precise as time stamps in files.
double whole_microseconds(double seconds) { return std::round(seconds * 1e6) / 1e6; }

CameraModel checked(const CameraModel& camera) {
  const bool bent = std::any_of(camera.distortion.begin(), camera.distortion.end(),
                                [](double k) { return k != 0; });
  if (bent || !camera.crop.empty())
    throw Error(Fault::kUsage, "a simulated camera has neither distortion nor crop",
                "camera '" + camera.name + "'", "leave both out");
  return camera;
}

}  // namespace

CameraModel default_camera() {
  return {.name = "simulated",
          .fx = 535.4,
          .fy = 539.2,
          .cx = 320.1,
          .cy = 247.6,
          .depth_noise = 0.0016,
          .surface_noise = 0.0016};
}

Simulator::Simulator(const SceneOptions& scene, const CameraModel& camera, int threads) try
    : scene_(scene),
      camera_(checked(camera)),
      world_(std::make_shared<const World>(build_world(scene))),
      motion_(scene.motion, scene.seed),
      renderer_(*world_, motion_, camera_.undistorted(), threads),
      sensor_(scene.sensor, scene.seed, camera.depth_factor, threads) {
} catch (...) {
  rethrow_named();
}

Simulator::Simulator(const Simulator& other) try
    : scene_(other.scene_),
      camera_(other.camera_),
      world_(other.world_),
      motion_(other.motion_),
      renderer_(*world_, motion_, camera_.undistorted(), other.renderer_.threads()),
      sensor_(other.sensor_) {
} catch (...) {
  rethrow_named();
}

double Simulator::stamp(int index) const {
  return whole_microseconds(scene_.start_time + index / scene_.rate);
}

double Simulator::depth_stamp(int index) const {
  const double offset =
      scene_.sensor.depth_offset + scene_.sensor.depth_offset_drift * index / scene_.rate;
  // Two clocks that run apart: the nearest depth image is never farther than half a frame.
  const double rolled = offset - std::round(offset * scene_.rate) / scene_.rate;
  return whole_microseconds(stamp(index) + rolled);
}

Pose Simulator::world_from_camera(double stamp) const {
  return motion_.world_from_camera(stamp - scene_.start_time);
}

SimulatedFrame Simulator::frame(int index) try {
  SimulatedFrame frame{.index = index, .time = stamp(index), .depth_time = depth_stamp(index)};
  const double time = frame.time - scene_.start_time;
  frame.world_from_camera = world_from_camera(frame.time);
  const View view = renderer_.render(time, scene_.sensor.ideal ? 0 : scene_.sensor.exposure);
  frame.bgr = sensor_.color_image(view, index, time);
  frame.labels = view.labels;
  frame.instances = view.instances;
  const bool together = frame.depth_time == frame.time;
  frame.depth = sensor_.depth_image(
      together ? view : renderer_.render_geometry(frame.depth_time - scene_.start_time), index);
  return frame;
} catch (...) {
  rethrow_named();
}

}  // namespace stillpoint::simulation
