// Rendered RGB-D images with exact poses and depth, for tests: textured panels that face along z.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb_slam {

// A rectangle at depth z of the world, metres.
struct Panel {
  double left, top, width, height, z;
};

class TestScene {
 public:
  // Back to front.
  explicit TestScene(std::vector<Panel> panels) : panels_(std::move(panels)) {
    for (std::size_t i = 0; i < panels_.size(); ++i)
      textures_.push_back(texture(panels_[i], 17 + i));
  }
  // A wall and two things in front of it.
  TestScene()
      : TestScene({{-4, -3, 8, 6, 3.0}, {-1.6, -0.6, 1.1, 1.5, 2.2}, {0.4, -0.2, 0.9, 1.2, 1.8}}) {}

  FramePtr render(const Pose& world_from_camera, std::uint32_t index) const {
    auto frame = std::make_shared<Frame>();
    frame->index = index;
    frame->time = index / 30.0;
    frame->camera = camera_;
    frame->gray = cv::Mat::zeros(camera_->height, camera_->width, CV_8UC1);
    frame->depth = cv::Mat::zeros(frame->gray.size(), CV_32FC1);
    for (std::size_t i = 0; i < panels_.size(); ++i) paint(i, world_from_camera, *frame);
    cv::cvtColor(frame->gray, frame->bgr, cv::COLOR_GRAY2BGR);
    return frame;
  }
  FramePtr black(std::uint32_t index) const {
    return TestScene(std::vector<Panel>{}).render(Pose::Identity(), index);
  }

 private:
  static constexpr double kTexelsPerMetre = 250;

  static cv::Mat texture(const Panel& panel, std::uint64_t seed) {
    cv::RNG random(seed);
    const cv::Size size(cvRound(panel.width * kTexelsPerMetre),
                        cvRound(panel.height * kTexelsPerMetre));
    cv::Mat image(size, CV_8UC1, cv::Scalar(128));
    for (int i = 0; i < size.area() / 500; ++i) {
      const cv::Point corner(random.uniform(-20, size.width), random.uniform(-20, size.height));
      const cv::Size box(random.uniform(5, 50), random.uniform(5, 50));
      cv::rectangle(image, cv::Rect(corner, box), cv::Scalar(random.uniform(10, 246)), cv::FILLED);
    }
    cv::GaussianBlur(image, image, {}, 0.8);
    return image;
  }

  void paint(std::size_t index, const Pose& world_from_camera, Frame& frame) const {
    const Panel& panel = panels_[index];
    const Pose camera_from_world = world_from_camera.inverse();
    cv::Matx33d image_from_texture;
    for (int row = 0; row < 3; ++row) {
      const auto r = camera_from_world.linear().row(row);
      image_from_texture(row, 0) = r.x() / kTexelsPerMetre;
      image_from_texture(row, 1) = r.y() / kTexelsPerMetre;
      image_from_texture(row, 2) = r.dot(Eigen::Vector3d(panel.left, panel.top, panel.z)) +
                                   camera_from_world.translation()[row];
    }
    const Camera& c = *camera_;
    image_from_texture = cv::Matx33d(c.fx, 0, c.cx, 0, c.fy, c.cy, 0, 0, 1) * image_from_texture;
    cv::warpPerspective(textures_[index], frame.gray, image_from_texture, frame.gray.size(),
                        cv::INTER_LINEAR, cv::BORDER_TRANSPARENT);
    set_depth(panel, world_from_camera, frame.depth);
  }

  void set_depth(const Panel& panel, const Pose& world_from_camera, cv::Mat& depth) const {
    const Eigen::Vector3d eye = world_from_camera.translation();
    for (int v = 0; v < depth.rows; ++v) {
      for (int u = 0; u < depth.cols; ++u) {
        const Eigen::Vector3d ray = world_from_camera.linear() * camera_->unproject(u, v, 1.0);
        const double z = (panel.z - eye.z()) / ray.z();
        const Eigen::Vector3d p = eye + z * ray;
        if (z > 0 && p.x() >= panel.left && p.x() < panel.left + panel.width &&
            p.y() >= panel.top && p.y() < panel.top + panel.height)
          depth.at<float>(v, u) = static_cast<float>(z);
      }
    }
  }

  std::vector<Panel> panels_;
  std::vector<cv::Mat> textures_;
  std::shared_ptr<const Camera> camera_ = std::make_shared<Camera>();
};

}  // namespace stillpoint::orb_slam
