// A room of boxes with exact depth images, for tests.
#pragma once

#include <stillpoint/sdk.hpp>

#include <limits>
#include <opencv2/core.hpp>
#include <vector>

namespace stillpoint::map_checks {

/// In the world, metres: x right, y down, z forward as seen by the first camera.
struct TestBox {
  Eigen::Vector3d low, high;
};

class TestRoom {
 public:
  explicit TestRoom(cv::Size size = {320, 240}) {
    Camera camera;
    camera.width = size.width;
    camera.height = size.height;
    camera.fx = camera.fy = 260;
    camera.cx = (size.width - 1) / 2.0;
    camera.cy = (size.height - 1) / 2.0;
    camera_ = std::make_shared<const Camera>(camera);
  }

  /// A wall, a side wall, a floor and a table.
  std::vector<TestBox> boxes = {{{-6, -3, 4}, {6, 3, 4.2}},
                                {{-2.2, -3, -1}, {-2, 3, 5}},
                                {{-6, 1.2, -1}, {6, 1.4, 5}},
                                {{0.6, 0.5, 2.4}, {1.6, 1.2, 3.0}}};

  std::shared_ptr<const Frame> render(const Pose& world_from_camera, double time) const {
    auto frame = std::make_shared<Frame>();
    frame->index = static_cast<std::uint32_t>(time * 30 + 0.5);
    frame->time = time;
    frame->camera = camera_;
    frame->gray = cv::Mat(camera_->height, camera_->width, CV_8UC1, cv::Scalar(128));
    frame->depth = cv::Mat(frame->gray.size(), CV_32FC1);
    for (int y = 0; y < frame->depth.rows; ++y)
      for (int x = 0; x < frame->depth.cols; ++x)
        frame->depth.at<float>(y, x) = depth_of(world_from_camera, x, y);
    return frame;
  }

  /// Not 0 where a box is what is seen, on cells of `cell` px.
  cv::Mat cells_of(const TestBox& box, const Pose& world_from_camera, int cell) const {
    cv::Mat mask(camera_->height / cell, camera_->width / cell, CV_8U, cv::Scalar(0));
    for (int y = 0; y < mask.rows; ++y)
      for (int x = 0; x < mask.cols; ++x) {
        const int u = x * cell + cell / 2, v = y * cell + cell / 2;
        const auto z = static_cast<float>(intersect(box, world_from_camera, ray(u, v)));
        if (z <= depth_of(world_from_camera, u, v)) mask.at<std::uint8_t>(y, x) = 255;
      }
    return mask;
  }

 private:
  Eigen::Vector3d ray(int u, int v) const { return camera_->unproject(u, v, 1); }

  float depth_of(const Pose& world_from_camera, int u, int v) const {
    double nearest = std::numeric_limits<float>::max();
    for (const TestBox& box : boxes)
      nearest = std::min(nearest, intersect(box, world_from_camera, ray(u, v)));
    return nearest < 100 ? static_cast<float>(nearest) : 0.0F;
  }

  // Depth along z at which a ray meets a box: the slab method.
  static double intersect(const TestBox& box, const Pose& world_from_camera,
                          const Eigen::Vector3d& ray) {
    const Eigen::Vector3d eye = world_from_camera.translation();
    const Eigen::Vector3d along = world_from_camera.linear() * ray;
    double enter = 0, leave = std::numeric_limits<double>::max();
    for (int axis = 0; axis < 3; ++axis) {
      const double inverse = 1 / (along[axis] == 0 ? 1e-12 : along[axis]);
      const double a = (box.low[axis] - eye[axis]) * inverse;
      const double b = (box.high[axis] - eye[axis]) * inverse;
      enter = std::max(enter, std::min(a, b));
      leave = std::min(leave, std::max(a, b));
    }
    return enter < leave && enter > 0 ? enter : std::numeric_limits<double>::max();
  }

  std::shared_ptr<const Camera> camera_;
};

}  // namespace stillpoint::map_checks
