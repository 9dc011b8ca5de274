// Images of one's own through Stillpoint. They come from a camera that slides 5 mm per frame along
// a painted wall two metres away; yours come from a driver.
#include <cstdio>
#include <opencv2/imgproc.hpp>
#include <stillpoint/engine/engine.hpp>
#include <stillpoint/support/rectifier.hpp>

using namespace stillpoint;

int main() try {
  const CameraModel model{
      .name = "mine", .fx = 400, .fy = 400, .cx = 319.5, .cy = 239.5, .depth_factor = 1000};  // mm
  const Rectifier rectifier(model);           // undistorts, scales depth
  const double distance = 2.0, step = 0.005;  // metres

  cv::Mat wall(480, 1000, CV_8UC3);
  cv::randu(wall, 0, 256);
  cv::GaussianBlur(wall, wall, {}, 3.0);
  cv::normalize(wall, wall, 0, 255, cv::NORM_MINMAX);
  const cv::Mat depth(480, 640, CV_16UC1, cv::Scalar(distance * model.depth_factor));

  Engine engine({.request = {.pipeline = "orb_baseline", .pushed = true}});
  for (int i = 0; i < 60; ++i) {
    const double shift = step * i * model.fx / distance;  // px; whole pixels every frame
    const cv::Mat image = wall(cv::Rect(static_cast<int>(shift), 0, 640, 480)).clone();
    const FrameReportPtr report = engine.process(rectifier.frame(i / 30.0, image, depth));
    if (report->result.state != TrackState::kTracking) std::printf("frame %d: no pose\n", i);
  }
  engine.finish();

  const StampedPose last = engine.trajectory().back();
  const Eigen::Vector3d position = last.world_from_camera.translation();
  std::printf("after %.2f s at %.3f %.3f %.3f m; %zu key frames, %zu landmarks\n", last.time,
              position.x(), position.y(), position.z(), engine.map()->keyframe_count(),
              engine.map()->landmark_count());
} catch (const Error& error) {
  std::fprintf(stderr, "push_frames: %s\n", error.what());
  return error.exit_code();
}
