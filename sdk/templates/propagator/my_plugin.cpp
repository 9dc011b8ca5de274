#include "my_plugin.hpp"

#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <stillpoint/support/median.hpp>
#include <stillpoint/support/objects.hpp>

namespace plugins::my_plugin {

stillpoint::Segmentation MyPlugin::propagate(const stillpoint::Segmentation& segmentation,
                                             const stillpoint::Frame& from,
                                             const stillpoint::Frame& to) {
  stillpoint::Segmentation known = segmentation;
  if (!known.known() || from.index == to.index) return known;
  if (known.instances.empty()) {
    known.labels = known.labels.clone();  // images are shared
    stillpoint::find_objects(known, 1);
  }
  stillpoint::Segmentation result;
  result.frame = to.index;
  result.labels = cv::Mat::zeros(known.labels.size(), CV_8UC1);
  result.instances = cv::Mat::zeros(known.labels.size(), CV_8UC1);
  const cv::Rect image({}, known.labels.size());
  for (std::size_t i = 0; i < known.objects.size(); ++i) {
    const cv::Mat mask = known.instances == static_cast<double>(i + 1);
    stillpoint::SegmentedObject object = known.objects[i];
    const cv::Point motion = motion_of(mask, object.box, from, to);
    const cv::Rect target = (object.box + motion) & image;
    if (target.empty()) continue;  // it has left the image
    const cv::Mat moved = mask(target - motion);
    if (cv::countNonZero(moved) == 0) continue;
    object.box = target;
    result.objects.push_back(object);
    result.labels(target).setTo(object.label, moved);
    result.instances(target).setTo(static_cast<double>(result.objects.size()), moved);
  }
  for (std::size_t i = 0; i < result.objects.size(); ++i)  // one may now hide a part of another
    result.objects[i].pixels = cv::countNonZero(result.instances == static_cast<double>(i + 1));
  return result;
}

/// Median over points on a grid; an object turns and bends, but from one frame to the next little.
cv::Point MyPlugin::motion_of(const cv::Mat& mask, const cv::Rect& box,
                              const stillpoint::Frame& from, const stillpoint::Frame& to) const {
  std::vector<cv::Point2f> before, after;
  for (int y = box.y; y < box.br().y; y += options_.spacing)
    for (int x = box.x; x < box.br().x; x += options_.spacing)
      if (mask.at<std::uint8_t>(y, x) != 0)
        before.emplace_back(static_cast<float>(x), static_cast<float>(y));
  if (before.empty()) return {};
  std::vector<std::uint8_t> found;
  cv::calcOpticalFlowPyrLK(from.gray, to.gray, before, after, found, cv::noArray());
  const cv::Rect2f image(0, 0, static_cast<float>(to.gray.cols), static_cast<float>(to.gray.rows));
  std::vector<float> x, y;
  for (std::size_t i = 0; i < before.size(); ++i) {
    if (!found[i] || !image.contains(after[i])) continue;
    x.push_back(after[i].x - before[i].x);
    y.push_back(after[i].y - before[i].y);
  }
  if (static_cast<int>(x.size()) < options_.min_points) return {};
  return {cvRound(stillpoint::median(x)), cvRound(stillpoint::median(y))};
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Propagator, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "moves each object by the median optical flow of its points"));
