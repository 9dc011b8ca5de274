// Boxes before a wall, for the tests of this plugin.
#pragma once

#include <algorithm>
#include <memory>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/support/objects.hpp"

namespace stillpoint::propagator_flow_depth {

inline constexpr int kPerson = 15;
inline constexpr int kChair = 9;
inline const cv::Size kSize(320, 240);

/// A textured rectangle at some depth.
struct Box {
  cv::Rect area;
  float depth;
  int label;
};

inline cv::Mat texture(cv::Size size, int seed) {
  cv::Mat noise(size.height / 4 + 1, size.width / 4 + 1, CV_8UC1), image;
  cv::RNG(static_cast<std::uint64_t>(seed)).fill(noise, cv::RNG::UNIFORM, 0, 256);
  cv::resize(noise, image, size, 0, 0, cv::INTER_CUBIC);
  return image;
}

/// A wall 4 m away and boxes before it; later boxes lie over earlier ones.
struct Scene {
  Frame frame;
  cv::Mat labels{kSize, CV_8UC1, cv::Scalar(0)};

  Scene(std::uint32_t index, const std::vector<Box>& boxes) {
    frame.index = index;
    frame.time = index / 30.0;
    frame.gray = texture(kSize, 1);
    frame.depth = cv::Mat(kSize, CV_32FC1, cv::Scalar(4));
    Camera camera;
    camera.fx = camera.fy = 260;
    frame.camera = std::make_shared<const Camera>(camera);
    int seed = 2;
    for (const Box& box : boxes) {
      const cv::Rect seen = box.area & cv::Rect({}, kSize);
      const cv::Mat skin = texture(box.area.size(), seed++);
      if (seen.empty()) continue;
      skin(seen - box.area.tl()).copyTo(frame.gray(seen));
      frame.depth(seen).setTo(box.depth);
      labels(seen).setTo(box.label);
    }
  }
  Segmentation truth() const {
    Segmentation result{.labels = labels, .frame = frame.index};
    find_objects(result, 20);
    return result;
  }
  Segmentation nothing() const {
    return {.labels = cv::Mat(kSize, CV_8UC1, cv::Scalar(0)),
            .instances = cv::Mat(kSize, CV_8UC1, cv::Scalar(0)),
            .frame = frame.index};
  }
};

inline double overlap(const cv::Mat& a, const cv::Mat& b, int label = kPerson) {
  const cv::Mat x = a == label, y = b == label;
  return static_cast<double>(cv::countNonZero(x & y)) / std::max(1, cv::countNonZero(x | y));
}

inline Box walker(int index, int label = kPerson) {
  return {{60 + 5 * index, 60, 60, 120}, 2.0f, label};
}

}  // namespace stillpoint::propagator_flow_depth
