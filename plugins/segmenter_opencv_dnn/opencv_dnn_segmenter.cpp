#include "segmenter_opencv_dnn/opencv_dnn_segmenter.hpp"

#include <algorithm>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include "stillpoint/support/objects.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

std::string shape_text(const cv::Mat& output) {
  std::string text;
  for (int i = 0; i < output.dims; ++i)
    text += (i > 0 ? " x " : "") + std::to_string(output.size[i]);
  return text;
}

int use_threads(int wanted, const StageContext& context) {
  const int threads = wanted > 0 ? wanted : context.threads;
  cv::setNumThreads(threads);
  return threads;
}

cv::Rect pixels_of(const cv::Rect2f& box, cv::Size image) {
  const cv::Point first(cvRound(box.x * image.width), cvRound(box.y * image.height));
  const cv::Point end(cvRound(box.br().x * image.width), cvRound(box.br().y * image.height));
  return cv::Rect(first, end) & cv::Rect({}, image);
}

/// Updates size and box of each object: better ones may have taken pixels from it.
void measure_objects(Segmentation& segmentation) {
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    SegmentedObject& object = segmentation.objects[i];
    const cv::Mat mask = segmentation.instances(object.box) == static_cast<double>(i + 1);
    object.pixels = cv::countNonZero(mask);
    if (object.pixels > 0) object.box = cv::boundingRect(mask) + object.box.tl();
  }
}

cv::Mat mirrored(const cv::Mat& image) {
  cv::Mat result;
  if (!image.empty()) cv::flip(image, result, 1);
  return result;
}

/// All images that segmentation reads, mirrored.
Frame mirrored(const Frame& frame) {
  Frame result = frame;
  for (cv::Mat* image : {&result.bgr, &result.gray, &result.depth}) *image = mirrored(*image);
  return result;
}

Segmentation mirrored(Segmentation segmentation) {
  for (cv::Mat* image : {&segmentation.labels, &segmentation.instances}) *image = mirrored(*image);
  for (SegmentedObject& object : segmentation.objects)
    object.box.x = segmentation.labels.cols - object.box.br().x;
  return segmentation;
}

}  // namespace

void OpenCvDnnSegmenter::Options::visit(OptionVisitor& v) {
  network.visit(v);
  v.choice("result", rule.result,
           {{"class_logits", ResultKind::kClassLogits},
            {"class_probabilities", ResultKind::kClassProbabilities},
            {"probability", ResultKind::kProbability},
            {"logit", ResultKind::kLogit},
            {"boxes", ResultKind::kBoxes}},
           {.help = "what the output is: one plane per class, one plane for one class, or boxes"});
  v.choice(
      "cells", cells, {{"centres", CellAlignment::kCentres}, {"corners", CellAlignment::kCorners}},
      {.help = "where the cells of the output lie in the input: side by side, or the outer ones on "
               "its corners (align_corners: networks of stride 16 with inputs of 16 k + 1 px)"});
  v("classes", classes,
    {.help = "names by class id, the background first; or one of the lists [voc21], [coco80], "
             "[person]"});
  v("threshold", rule.threshold,
    {.min = 0, .max = 1, .help = "a probability or a box's score below it is background"});
  v("margin", rule.margin,
    {.help = "by how much a class's logit must exceed the background's; larger: fewer false "
             "labels, more misses"});
  v("refine", refinement, {.help = "guided filter that brings scores to the edges of the image"});
  v("boxes", boxes, {.help = "how boxes become masks"});
  v("min_object_pixels", smallest.pixels,
    {.min = 1, .unit = "px", .help = "smaller parts of a class are background"});
  v("min_object_area", smallest.area,
    {.min = 0,
     .unit = "m^2",
     .help = "parts of a class whose visible area (by depth) times mean probability is smaller are "
             "background"});
  v("mirror", mirror,
    {.help = "every second image is mirrored for the network, and its labels are mirrored back"});
  v("threads", threads,
    {.min = 0,
     .max = 256,
     .help = "threads of OpenCV, in the whole process; 0: as many as the runtime gives a stage"});
  v.require(refinement.radius == 0 || cells == CellAlignment::kCentres,
            "'refine' needs cells that tile the input: 'cells: centres'");
}

OpenCvDnnSegmenter::OpenCvDnnSegmenter(const Options& options, const StageContext& context)
    : options_(options),
      classes_(classes_of(options.classes)),
      network_((use_threads(options.threads, context), options.network),
               options.rule.result == ResultKind::kBoxes),
      log_(context.log) {
  check_outputs();
}

void OpenCvDnnSegmenter::check_outputs() const {
  for (const cv::Mat& output : network_.trial_outputs())
    if (options_.rule.result == ResultKind::kBoxes)
      check_boxes(output);
    else
      check_planes(output);
}

void OpenCvDnnSegmenter::refuse(const cv::Mat& output, const std::string& expected) const {
  throw Error(Fault::kUsage, "the output is " + shape_text(output) + ", not " + expected,
              network_.file(), "check 'result', 'output' and 'classes'");
}

void OpenCvDnnSegmenter::check_boxes(const cv::Mat& output) const {
  const std::size_t names = classes_.size();
  if (!holds_boxes(output, names))
    refuse(output, "N x " + std::to_string(names + 4) + " (Darknet, " + std::to_string(names - 1) +
                       " classes) or 1 x 1 x N x 7 (SSD)");
}

void OpenCvDnnSegmenter::check_planes(const cv::Mat& output) const {
  const bool one = options_.rule.result == ResultKind::kProbability ||
                   options_.rule.result == ResultKind::kLogit;
  const std::size_t planes = one ? 1 : classes_.size();
  if (planes_of(output).size() != planes)
    refuse(output, "1 x " + std::to_string(planes) + " x height x width");
  if (one && classes_.size() != 2)
    throw Error(Fault::kUsage,
                "one plane of scores needs two names, the background and one class; 'classes' "
                "has " +
                    std::to_string(classes_.size()),
                network_.file(), "correct 'classes', such as [person]");
  const cv::Size cells = planes_of(output).front().size();
  const cv::Size input = network_.input_size();
  const auto fits = [](int pixels, int count) {
    return count == 1 || (pixels - 1) % (count - 1) == 0;
  };
  if (options_.cells == CellAlignment::kCorners &&
      !(fits(input.width, cells.width) && fits(input.height, cells.height)))
    throw Error(Fault::kUsage,
                "the corners of an input of " + size_text(input) +
                    " pixels are no cells of an "
                    "output of " +
                    size_text(cells),
                network_.file(),
                "make 'width' and 'height' a multiple of the network's stride plus 1, such as "
                "513 and 385, or use 'cells: centres'");
}

Segmentation OpenCvDnnSegmenter::segment(const Frame& frame) {
  const bool second = images_++ % 2 == 1;
  return options_.mirror && second ? mirrored(segment_as_is(mirrored(frame)))
                                   : segment_as_is(frame);
}

Segmentation OpenCvDnnSegmenter::segment_as_is(const Frame& frame) {
  const std::vector<cv::Mat> outputs = network_.run(frame.bgr);
  warn_of_darkness(frame);
  Segmentation result =
      options_.rule.result == ResultKind::kBoxes
          ? from_boxes(detections(outputs, classes_.size(), options_.rule.threshold,
                                  options_.boxes.overlap),
                       frame)
          : from_scores(outputs.front(), frame);
  result.frame = frame.index;
  return result;
}

void OpenCvDnnSegmenter::warn_of_darkness(const Frame& frame) {
  if (has_warned_ || !network_.brightened()) return;
  has_warned_ = true;
  log_(LogLevel::kWarning, "dark images, such as frame " + std::to_string(frame.index) +
                               ", are brightened for the network; more light or a longer exposure "
                               "helps");
}

Segmentation OpenCvDnnSegmenter::from_scores(const cv::Mat& output, const Frame& frame) {
  std::vector<cv::Mat> planes = planes_of(output);
  if (options_.refinement.radius > 0) {
    const GuidedFilter refined(frame.gray, planes.front().size(), options_.refinement);
    for (cv::Mat& plane : planes) plane = refined(plane);
  }
  if (grid_.image != frame.bgr.size())
    grid_ =
        CellGrid(options_.cells, planes.front().size(), network_.input_size(), frame.bgr.size());
  Segmentation result;
  result.labels = label_pixels(competing_planes(planes, options_.rule), grid_);
  find_objects(result, options_.smallest.pixels);
  if (!result.objects.empty())
    score_objects(result, probabilities(planes, options_.rule.result), grid_);
  remove_small_objects(result, frame, options_.smallest);
  return result;
}

Segmentation OpenCvDnnSegmenter::from_boxes(std::vector<Detection> found,
                                            const Frame& frame) const {
  if (found.size() > kMostObjects) found.resize(kMostObjects);
  Segmentation result;
  result.labels = cv::Mat(frame.bgr.size(), CV_8UC1, cv::Scalar(0));
  result.instances = cv::Mat(frame.bgr.size(), CV_8UC1, cv::Scalar(0));
  const double noise = (frame.camera ? *frame.camera : Camera()).surface_noise;
  // The best one last: where two boxes share a surface, it is the better one's.
  std::ranges::reverse(found);
  for (const Detection& detection : found) {
    const cv::Rect box = pixels_of(detection.box, frame.bgr.size());
    if (box.empty()) continue;
    const cv::Mat mask = box_mask(frame.depth, noise, box, options_.boxes);
    result.objects.push_back({.label = detection.label, .box = box, .score = detection.score});
    result.labels(box).setTo(detection.label, mask);
    result.instances(box).setTo(static_cast<double>(result.objects.size()), mask);
  }
  measure_objects(result);
  remove_small_objects(result, frame, options_.smallest);
  return result;
}

}  // namespace stillpoint::segmenter_opencv_dnn
