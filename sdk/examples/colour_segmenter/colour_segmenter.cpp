#include "colour_segmenter.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <set>
#include <stillpoint/support/objects.hpp>

namespace {

constexpr std::size_t kMostClasses = 255;  // labels are 8-bit, and 0 is the background

cv::Mat disc(int radius) {
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

/// Whether every class has a name of its own.
bool names_differ(const std::vector<ColourClass>& classes) {
  std::set<std::string> names = {"", "background"};
  return std::ranges::all_of(classes,
                             [&](const auto& one) { return names.insert(one.name).second; });
}

}  // namespace

void ColourClass::visit(stillpoint::OptionVisitor& v) {
  v("name", name, {.help = "decisions ask for the class by this name", .required = true});
  v("hue", hue,
    {.min = 0,
     .max = 360,
     .unit = "degrees",
     .help = "first and last; 0 red, 60 yellow, 120 green, 240 blue; [350, 10] goes across red",
     .required = true});
  v("min_saturation", min_saturation, {.min = 0, .max = 1, .help = "what is greyer is not it"});
  v("min_value", min_value, {.min = 0, .max = 1, .help = "what is darker is not it"});
  v.require(hue.size() == 2, "hue takes two angles, the first and the last");
}

void ColourSegmenter::Options::visit(stillpoint::OptionVisitor& v) {
  v("classes", classes, {.help = "of a pixel that fits several, the first one counts"});
  v("speckle", speckle,
    {.min = 0, .max = 20, .unit = "px", .help = "radius; what is thinner than it is noise"});
  v("gap", gap,
    {.min = 0, .max = 50, .unit = "px", .help = "radius of holes that are closed, as of stripes"});
  v("min_pixels", min_pixels, {.min = 1, .unit = "px", .help = "smaller objects are background"});
  v.require(!classes.empty() && classes.size() <= kMostClasses, "classes takes 1 to 255 of them");
  v.require(names_differ(classes),
            "each class needs a name of its own, which is not that of the background");
}

stillpoint::ClassNames ColourSegmenter::classes() const {
  stillpoint::ClassNames names = {"background"};
  for (const ColourClass& colour : options_.classes) names.push_back(colour.name);
  return names;
}

stillpoint::Segmentation ColourSegmenter::segment(const stillpoint::Frame& frame) {
  cv::Mat hsv;
  cv::cvtColor(frame.bgr, hsv, cv::COLOR_BGR2HSV);
  stillpoint::Segmentation result{.labels = cv::Mat::zeros(hsv.size(), CV_8UC1),
                                  .frame = frame.index};
  int label = 0;
  for (const ColourClass& colour : options_.classes)
    result.labels.setTo(++label, mask_of(colour, hsv) & (result.labels == 0));
  stillpoint::find_objects(result, options_.min_pixels);
  return result;
}

/// `hsv` as OpenCV has it in 8 bits: hue in steps of 2 degrees, saturation and value up to 255.
cv::Mat ColourSegmenter::mask_of(const ColourClass& colour, const cv::Mat& hsv) const {
  const auto between = [&](double first, double last) {
    cv::Mat mask;
    cv::inRange(hsv, cv::Scalar(first / 2, 255 * colour.min_saturation, 255 * colour.min_value),
                cv::Scalar(last / 2, 255, 255), mask);
    return mask;
  };
  const double first = colour.hue.front(), last = colour.hue.back();
  cv::Mat mask =
      first <= last ? between(first, last) : cv::Mat(between(first, 360) | between(0, last));
  cv::morphologyEx(mask, mask, cv::MORPH_OPEN, disc(options_.speckle));
  cv::morphologyEx(mask, mask, cv::MORPH_CLOSE, disc(options_.gap));
  return mask;
}

STILLPOINT_PLUGIN(colour_segmenter, "0.1.0",
                  stillpoint::provide<stillpoint::Segmenter, ColourSegmenter>(
                      "colours", "classes by their hue, such as vests in signal colours"));
