// Depth images of planes without any texture, with exact poses, for tests.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::orb_slam {

// normal·x = distance, metres; unbounded, seen from either side.
struct WorldPlane {
  Eigen::Vector3d normal;
  double distance = 0.0;
};

// In the world of the first camera: ahead, to the right, and the floor.
inline const WorldPlane kAhead{{0, 0, 1}, 2.5};
inline const WorldPlane kRight{{1, 0, 0}, 0.9};
inline const WorldPlane kFloor{{0, 1, 0}, 0.8};

// `noise`: standard deviation of the inverse depth, 1/m.
inline FramePtr render_planes(const std::vector<WorldPlane>& planes, const Pose& world_from_camera,
                              std::uint32_t index = 0, double noise = 0.0) {
  auto frame = std::make_shared<Frame>();
  auto camera = std::make_shared<Camera>();
  frame->index = index;
  frame->time = index / 30.0;
  frame->gray = cv::Mat(camera->height, camera->width, CV_8UC1, cv::Scalar(150));
  frame->bgr = cv::Mat(frame->gray.size(), CV_8UC3, cv::Scalar::all(150));
  frame->depth = cv::Mat::zeros(frame->gray.size(), CV_32FC1);
  cv::RNG random(index + 1);
  const Eigen::Vector3d eye = world_from_camera.translation();
  for (int v = 0; v < camera->height; ++v) {
    for (int u = 0; u < camera->width; ++u) {
      const Eigen::Vector3d ray = world_from_camera.linear() * camera->unproject(u, v, 1.0);
      double inverse = 0.0;
      for (const WorldPlane& plane : planes)
        inverse =
            std::max(inverse, plane.normal.dot(ray) / (plane.distance - plane.normal.dot(eye)));
      inverse += noise > 0 ? random.gaussian(noise) : 0.0;
      if (inverse > 0.1) frame->depth.at<float>(v, u) = static_cast<float>(1.0 / inverse);
    }
  }
  frame->camera = std::move(camera);
  return frame;
}

/// The same frame of a sensor that is known to have this noise (Camera::surface_noise).
inline FramePtr with_surface_noise(const FramePtr& frame, double noise) {
  auto camera = std::make_shared<Camera>(*frame->camera);
  camera->surface_noise = noise;
  auto noisy = std::make_shared<Frame>(*frame);
  noisy->camera = std::move(camera);
  return noisy;
}

}  // namespace stillpoint::orb_slam
