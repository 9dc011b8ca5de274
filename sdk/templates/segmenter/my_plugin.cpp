#include "my_plugin.hpp"

#include <opencv2/imgproc.hpp>
#include <stillpoint/support/objects.hpp>

namespace plugins::my_plugin {
namespace {

/// 255 where hue, saturation and value are in the range. OpenCV's hues in 8 bits are 0 to 179, in
/// steps of two degrees.
cv::Mat in_range(const cv::Mat& hsv, const MyPlugin::Options& options) {
  const auto between = [&](int low, int high) {
    cv::Mat mask;
    cv::inRange(hsv, cv::Scalar(low, options.min_saturation, options.min_value),
                cv::Scalar(high, 255, 255), mask);
    return mask;
  };
  const int first = options.min_hue / 2, last = options.max_hue / 2;
  if (options.min_hue <= options.max_hue) return between(first, last);
  return between(first, 179) | between(0, last);
}

}  // namespace

void MyPlugin::Options::visit(stillpoint::OptionVisitor& v) {
  v("class_name", class_name, {.help = "what it is; decisions ask for it by this name"});
  v("min_hue", min_hue,
    {.min = 0, .max = 359, .unit = "degrees", .help = "first hue; 0 red, 120 green, 240 blue"});
  v("max_hue", max_hue,
    {.min = 0, .max = 359, .unit = "degrees", .help = "last hue; below min_hue: across red"});
  v("min_saturation", min_saturation, {.min = 0, .max = 255, .help = "what is greyer is not it"});
  v("min_value", min_value, {.min = 0, .max = 255, .help = "what is darker is not it"});
  v("min_pixels", min_pixels, {.min = 1, .unit = "px", .help = "smaller objects are background"});
  v.require(!class_name.empty() && class_name != "background",
            "class_name must be the name of a class other than background");
}

stillpoint::Segmentation MyPlugin::segment(const stillpoint::Frame& frame) {
  cv::Mat hsv;
  cv::cvtColor(frame.bgr, hsv, cv::COLOR_BGR2HSV);
  stillpoint::Segmentation result;
  result.labels = in_range(hsv, options_) / 255;  // class id 1
  result.frame = frame.index;
  stillpoint::find_objects(result, options_.min_pixels);
  return result;
}

}  // namespace plugins::my_plugin

// What the library provides: the type `my_plugin`.
STILLPOINT_PLUGIN(my_plugin, "0.1.0",
                  stillpoint::provide<stillpoint::Segmenter, plugins::my_plugin::MyPlugin>(
                      "my_plugin", "labels what has a colour"));
