#include "my_plugin.hpp"

#include <opencv2/imgproc.hpp>
#include <utility>

namespace plugins::my_plugin {
namespace {

cv::Mat mask_of(const stillpoint::Segmentation& segmentation, std::size_t object) {
  if (!segmentation.instances.empty())
    return segmentation.instances == static_cast<double>(object + 1);
  cv::Mat mask = cv::Mat::zeros(segmentation.labels.size(), CV_8UC1);
  const cv::Rect box = segmentation.objects[object].box;
  cv::Mat(segmentation.labels(box) == segmentation.objects[object].label).copyTo(mask(box));
  return mask;
}

}  // namespace

MyPlugin::MyPlugin(Options options, const stillpoint::StageContext& context)
    : options_(std::move(options)) {
  if (context.classes.empty()) return;  // no segmenter
  for (const std::string& label : options_.labels)
    can_move_.at(static_cast<std::size_t>(stillpoint::class_id(context.classes, label))) = true;
}

stillpoint::StaticWeights MyPlugin::decide(const stillpoint::Frame& frame,
                                           const stillpoint::Segmentation& segmentation,
                                           const stillpoint::MovingPoints& moving,
                                           const stillpoint::MapEvidence&) {
  stillpoint::StaticWeights weights;
  weights.track = cv::Mat(frame.gray.size(), CV_8UC1, cv::Scalar(255));
  if (moving.reliable)
    for (const stillpoint::PointMotion& point : moving.points)
      if (point.moving)
        cv::circle(weights.track, point.current, options_.reach, cv::Scalar(0), cv::FILLED);
  weights.map = weights.track.clone();
  if (!segmentation.known()) return weights;
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    weights.object_moves.push_back(false);
    if (!can_move_.at(static_cast<std::size_t>(segmentation.objects[i].label))) continue;
    const cv::Mat mask = mask_of(segmentation, i);
    weights.map.setTo(0, mask);  // it may be gone tomorrow
    weights.object_moves.back() = moves(mask, moving);
    if (weights.object_moves.back()) weights.track.setTo(0, mask);
  }
  return weights;
}

/// While nothing reliable is known, what can move does.
bool MyPlugin::moves(const cv::Mat& mask, const stillpoint::MovingPoints& moving) const {
  if (!moving.reliable) return true;
  const cv::Rect image({}, mask.size());
  int count = 0;
  for (const stillpoint::PointMotion& point : moving.points) {
    const cv::Point pixel = point.current;
    if (point.moving && image.contains(pixel) && mask.at<std::uint8_t>(pixel) != 0) ++count;
  }
  return count >= options_.min_moving_points;
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Decision, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "weight 0 for objects with moving points"));
