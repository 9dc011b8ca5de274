// A small world for tests: textured boards that face the world's z axis, seen by an RGB-D camera.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::moving_checks {

struct Board {
  Eigen::Vector3d centre;        // metres; z is its distance from the world's origin
  double width = 1, height = 1;  // metres
  double texel = 0.01;           // metres
  int texture = 1;               // seed
  bool measured = true;          // whether depth is
};

class TestScene {
 public:
  std::vector<Board> boards;

  // A wall, and three boards at different distances before it.
  static TestScene room() {
    TestScene scene;
    scene.boards = {{{0, 0, 4}, 12, 9, 0.02, 1},
                    {{-1.0, -0.5, 3}, 0.9, 0.8, 0.015, 2},
                    {{1.0, -0.6, 2.5}, 0.8, 0.7, 0.012, 3},
                    {{-0.1, 0.8, 2.2}, 1.2, 0.5, 0.011, 4}};
    return scene;
  }

  Frame render(const Pose& world_from_camera, std::uint32_t index) const {
    Frame frame{.index = index,
                .time = index / 30.0,
                .gray = cv::Mat(camera_->height, camera_->width, CV_8UC1),
                .depth = cv::Mat(camera_->height, camera_->width, CV_32FC1),
                .camera = camera_};
    for (int v = 0; v < camera_->height; ++v)
      for (int u = 0; u < camera_->width; ++u) render_pixel(world_from_camera, u, v, frame);
    cv::cvtColor(frame.gray, frame.bgr, cv::COLOR_GRAY2BGR);
    return frame;
  }

  const Camera& camera() const { return *camera_; }

 private:
  void render_pixel(const Pose& world_from_camera, int u, int v, Frame& frame) const {
    const Eigen::Vector3d ray = camera_->unproject(u, v, 1.0);  // one metre deep
    const Eigen::Vector3d direction = world_from_camera.linear() * ray;
    const Eigen::Vector3d eye = world_from_camera.translation();
    double nearest = 1e9;
    frame.gray.at<std::uint8_t>(v, u) = 0;
    frame.depth.at<float>(v, u) = 0;
    for (const Board& board : boards) {
      const double depth = (board.centre.z() - eye.z()) / direction.z();
      const Eigen::Vector3d at = eye + depth * direction - board.centre;
      if (depth <= 0 || depth >= nearest || std::abs(at.x()) > board.width / 2 ||
          std::abs(at.y()) > board.height / 2)
        continue;
      nearest = depth;
      frame.gray.at<std::uint8_t>(v, u) = shade(board, at.x(), at.y());
      frame.depth.at<float>(v, u) = board.measured ? static_cast<float>(depth) : 0.0f;
    }
  }

  // Smooth noise of two sizes, 20 … 235.
  static std::uint8_t shade(const Board& board, double x, double y) {
    const double fine = noise(x / (4 * board.texel), y / (4 * board.texel), board.texture);
    const double coarse = noise(x / (9 * board.texel), y / (9 * board.texel), board.texture + 50);
    return static_cast<std::uint8_t>(20 + 215 * (0.5 * fine + 0.5 * coarse));
  }
  static double noise(double x, double y, int seed) {
    const double x0 = std::floor(x);
    const double y0 = std::floor(y);
    const double s = smooth(x - x0);
    const double t = smooth(y - y0);
    const auto at = [&](int dx, int dy) {
      return hashed(static_cast<int>(x0) + dx, static_cast<int>(y0) + dy, seed);
    };
    return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
  }
  static double smooth(double t) { return t * t * (3 - 2 * t); }
  static double hashed(int x, int y, int seed) {
    std::uint32_t h = static_cast<std::uint32_t>(x) * 374761393u +
                      static_cast<std::uint32_t>(y) * 668265263u +
                      static_cast<std::uint32_t>(seed) * 2246822519u;
    h = (h ^ (h >> 13)) * 1274126177u;
    h ^= h >> 16;
    return (h & 0xffff) / 65535.0;
  }

  std::shared_ptr<const Camera> camera_ = std::make_shared<const Camera>(
      Camera{.width = 320, .height = 240, .fx = 260, .fy = 260, .cx = 159.5, .cy = 119.5});
};

inline Pose camera_at(double x, double y, double z, double pan = 0, double tilt = 0) {
  Pose pose = Pose::Identity();
  pose.linear() = exp_so3({tilt, pan, 0});
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

}  // namespace stillpoint::moving_checks
