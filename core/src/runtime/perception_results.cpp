#include "stillpoint/runtime/perception_results.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/core.hpp>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "stillpoint/runtime/map_values.hpp"
#include "stillpoint/runtime/stage_requirement.hpp"
#include "stillpoint/support/median.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint {
namespace {

constexpr float kFarthestMedian = 200;  // metres; a room's is above that in millimetres

/// `what` is in the plural: "the labels".
void check_image(const cv::Mat& image, cv::Size frame, const std::string& what,
                 const std::string& remedy) {
  require_of_stage(image.type() == CV_8UC1,
                   what + " are of " + cv::typeToString(image.type()) + ", not of CV_8UC1", remedy);
  require_of_stage(
      image.size() == frame,
      what + " have " + size_text(image.size()) + " pixels, but the frame has " + size_text(frame),
      remedy);
}

void check_type(const cv::Mat& image, int type, const std::string& what) {
  require_of_stage(image.type() == type, what + " is of " + cv::typeToString(image.type()),
                   "it must be of " + cv::typeToString(type));
}

int highest(const cv::Mat& image) {
  double value = 0;
  cv::minMaxLoc(image, nullptr, &value);
  return static_cast<int>(value);
}

std::string text_of(const cv::Point2f& position) {
  std::ostringstream text;
  text << position.x << ", " << position.y;
  return text.str();
}

std::optional<cv::Point2f> position_outside(const MovingPoints& moving, cv::Size frame) {
  const cv::Rect image({}, frame);
  for (const PointMotion& point : moving.points)
    for (const cv::Point2f& position : {point.previous, point.current})
      if (!image.contains(cv::Point(position))) return position;
  return std::nullopt;
}

/// Whether squares of one number of pixels, so many in each direction, cover a frame; what is left
/// of it at the right and below may have cells of its own or none.
bool are_cells(cv::Size cells, cv::Size frame) {
  for (int side = 1; side <= std::max(frame.width, frame.height); ++side)
    if (std::abs(cells.width * side - frame.width) < side &&
        std::abs(cells.height * side - frame.height) < side)
      return true;
  return false;
}

/// Of the pixels with a measurement, from a sample of the image; 0 without any.
float median_depth(const cv::Mat& depth) {
  constexpr int kStep = 8;  // pixels
  std::vector<float> measured;
  for (int y = 0; y < depth.rows; y += kStep)
    for (int x = 0; x < depth.cols; x += kStep)
      if (const float z = depth.at<float>(y, x); z > 0) measured.push_back(z);
  return median(std::move(measured));
}

void check_objects(const Segmentation& segmentation, std::size_t classes) {
  const cv::Rect image({}, segmentation.labels.size());
  for (const SegmentedObject& object : segmentation.objects) {
    require_of_stage(object.label > 0 && object.label < static_cast<int>(classes),
                     "an object has label " + std::to_string(object.label) + " of " +
                         std::to_string(classes) + " classes",
                     "labels of objects count from 1 to classes() - 1");
    require_of_stage(object.pixels >= 0 && object.score >= 0 && object.score <= 1,
                     "an object has " + std::to_string(object.pixels) + " pixels and a score of " +
                         std::to_string(object.score),
                     "pixels are the size of its mask, the score lies from 0 to 1");
    require_of_stage(object.box.empty() || (object.box & image) == object.box,
                     "the box of an object is not in the image",
                     "boxes are in pixels of the frame");
  }
}

}  // namespace

void check_frame(const Frame& frame, std::uint32_t index, const Frame* previous) {
  require_of_stage(frame.index == index, "the frame has index " + std::to_string(frame.index),
                   "indices count from 0 without gaps");
  require_of_stage(std::isfinite(frame.time), "the time of the frame is not finite",
                   "give the time of the colour image in seconds");
  require_of_stage(!previous || frame.time >= previous->time,
                   "the frame is " + std::to_string(previous ? previous->time - frame.time : 0) +
                       " s older than the one before",
                   "give frames in order of time");
  require_of_stage(!frame.gray.empty(), "the frame has no image",
                   "leave out images that cannot be read");
  require_of_stage(frame.bgr.size() == frame.gray.size() && frame.depth.size() == frame.gray.size(),
                   "the colour, grey and depth images of a frame differ in size",
                   "all three are needed, of the camera's size");
  check_type(frame.bgr, CV_8UC3, "the colour image");
  check_type(frame.gray, CV_8UC1, "the grey image");
  check_type(frame.depth, CV_32FC1, "the depth image");
  require_of_stage(frame.camera != nullptr, "the frame has no camera", "set Frame::camera");
  require_of_stage(frame.gray.size() == cv::Size(frame.camera->width, frame.camera->height),
                   "the images have " + size_text(frame.gray.size()) + " pixels, the camera " +
                       size_text({frame.camera->width, frame.camera->height}),
                   "give images of the camera's size");
  require_of_stage(possible(*frame.camera), "the camera of the frame has impossible values",
                   "focal lengths lie between 1 and 1e6 px, the principal point within 1e6 px, the "
                   "noise of depth between 1e-6 and 100 m");
  require_of_stage(!previous || previous->gray.size() == frame.gray.size(),
                   "the images have another size than those before",
                   "all images of a run have one size");
  if (previous) return;
  const float depth = median_depth(frame.depth);
  require_of_stage(
      depth < kFarthestMedian,
      "half of the first depth image lies beyond " +
          std::to_string(static_cast<int>(std::min(depth, 1e9F))) + " m",
      "give depth in metres; of images in other units, the camera's depth_factor says it");
}

void check_segmentation(const Segmentation& segmentation, const Frame& of, std::size_t classes) {
  if (!segmentation.known()) return;
  const cv::Size frame = of.gray.size();
  require_of_stage(segmentation.frame == of.index,
                   "Segmentation::frame is " + std::to_string(segmentation.frame) + " for frame " +
                       std::to_string(of.index),
                   "set it to Frame::index: propagators tell by it which labels are new");
  check_image(segmentation.labels, frame, "the labels", "give one byte per pixel of the frame");
  const int label = highest(segmentation.labels);
  require_of_stage(label < std::max(1, static_cast<int>(classes)),
                   "a pixel has label " + std::to_string(label) + ", but there are " +
                       std::to_string(classes) + " classes",
                   "labels count from 0, the background, to classes() - 1");
  check_objects(segmentation, classes);
  if (segmentation.instances.empty()) return;
  check_image(segmentation.instances, frame, "the instances",
              "give one byte per pixel of the frame");
  const int instance = highest(segmentation.instances);
  require_of_stage(instance <= static_cast<int>(segmentation.objects.size()),
                   "a pixel belongs to object " + std::to_string(instance) + " of " +
                       std::to_string(segmentation.objects.size()),
                   "number instances from 1, as in the list of objects");
  const auto has_pixels = [](const SegmentedObject& object) { return object.pixels > 0; };
  require_of_stage(instance == 0 || std::ranges::any_of(segmentation.objects, has_pixels),
                   "all objects have 0 pixels, but there are instances",
                   "set SegmentedObject::pixels to the size of the mask; find_objects() does it");
}

void check_moving_points(const MovingPoints& moving, cv::Size frame) {
  require_of_stage(std::ranges::all_of(moving.points,
                                       [](const PointMotion& point) {
                                         return std::isfinite(point.previous.x + point.previous.y +
                                                              point.current.x + point.current.y);
                                       }),
                   "a point is not finite", "leave out points that were not found again");
  require_of_stage(!moving.camera_motion || is_rigid_motion(*moving.camera_motion),
                   "the camera's motion is no rigid motion",
                   "leave camera_motion empty where it was not found");
  if (const auto outside = position_outside(moving, frame))
    require_of_stage(false, "a point at " + text_of(*outside) + " is not in the image",
                     "points are in pixels of the frame; leave out those that left it");
}

void check_evidence(const MapEvidence& evidence, cv::Size frame) {
  if (evidence.log_odds.empty()) return;
  check_type(evidence.log_odds, CV_32FC1, "the evidence");
  require_of_stage(are_cells(evidence.log_odds.size(), frame),
                   "the evidence has " + size_text(evidence.log_odds.size()) +
                       " cells, which do not cover the frame of " + size_text(frame) +
                       " pixels as squares",
                   "give one value per square of n x n pixels, from the upper left corner on");
}

void check_weights(const StaticWeights& weights, const Segmentation& segmentation, cv::Size frame) {
  for (const cv::Mat* image : {&weights.track, &weights.map})
    if (!image->empty())
      check_image(*image, frame, "the weights",
                  "give one byte per pixel of the frame, or an empty image");
  require_of_stage(
      weights.object_moves.empty() || weights.object_moves.size() == segmentation.objects.size(),
      std::to_string(weights.object_moves.size()) + " objects are judged, but there are " +
          std::to_string(segmentation.objects.size()),
      "object_moves has one entry per object of the labels, or none");
}

}  // namespace stillpoint
