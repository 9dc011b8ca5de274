// Frames, labels and points with known truth, for tests.
#pragma once

#include "stillpoint/contracts/decision.hpp"
#include "stillpoint/plugin.hpp"
#include "stillpoint/support/objects.hpp"

namespace stillpoint::decision_objects {

inline const cv::Rect kPerson(200, 100, 120, 300);  // px
inline constexpr float kPersonDepth = 2.0F;         // m
inline constexpr float kWallDepth = 4.0F;           // m

/// A person before a wall.
inline Frame make_frame(std::uint32_t index = 0) {
  Frame frame;
  frame.index = index;
  frame.time = index / 30.0;
  frame.gray = cv::Mat(480, 640, CV_8UC1, cv::Scalar(128));
  frame.depth = cv::Mat(480, 640, CV_32FC1, cv::Scalar(kWallDepth));
  frame.depth(kPerson) = kPersonDepth;
  Camera camera;
  camera.width = 640;
  camera.height = 480;
  camera.fx = camera.fy = 535;
  camera.cx = 320;
  camera.cy = 240;
  frame.camera = std::make_shared<const Camera>(camera);
  return frame;
}

inline Segmentation make_labels(int label = 15, const cv::Rect& box = kPerson) {
  Segmentation segmentation{.labels = cv::Mat::zeros(480, 640, CV_8UC1)};
  segmentation.labels(box) = label;
  find_objects(segmentation, 1);
  return segmentation;
}

/// Points on a grid; those inside `moving_box` move, up to `moving_share` of them.
inline MovingPoints make_points(const cv::Rect& moving_box, double moving_share = 1.0) {
  MovingPoints points{.reliable = true};
  int inside = 0, moved = 0;
  for (int y = 10; y < 480; y += 20)
    for (int x = 10; x < 640; x += 20) {
      const cv::Point2f p(static_cast<float>(x), static_cast<float>(y));
      bool moving = false;
      if (moving_box.contains(p)) moving = moved < moving_share * ++inside;
      moved += moving ? 1 : 0;
      points.points.push_back({p, p, moving ? 5.0F : 0.1F, moving});
    }
  return points;
}

/// The same log-odds everywhere inside a box, none outside.
inline MapEvidence make_evidence(const cv::Rect& box, float log_odds) {
  constexpr int kCell = 4;  // px
  MapEvidence evidence{cv::Mat(480 / kCell, 640 / kCell, CV_32FC1, cv::Scalar(0))};
  evidence.log_odds(cv::Rect(box.x / kCell, box.y / kCell, box.width / kCell, box.height / kCell)) =
      log_odds;
  return evidence;
}

inline StageContext with_classes(const char* list = "voc21") {
  StageContext context;
  if (*list) context.classes = named_classes(list);
  return context;
}

inline int weight_at(const cv::Mat& weights, int x, int y) {
  return StaticWeights::at(weights, static_cast<float>(x), static_cast<float>(y));
}

}  // namespace stillpoint::decision_objects
