#include "segmenter_opencv_dnn/opencv_dnn_segmenter.hpp"

#include <algorithm>
#include <limits>
#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>

namespace stillpoint {
namespace {

constexpr std::size_t kMostClasses = 256;  // labels are 8-bit
constexpr std::size_t kMostObjects = 255;  // instances are 8-bit

ClassNames class_names(const std::vector<std::string>& given) {
  ClassNames names = given.size() == 1 ? named_classes(given.front()) : given;
  if (names.size() >= 2 && names.size() <= kMostClasses) return names;
  throw Error(Fault::kUsage, "'classes' has " + std::to_string(names.size()) + " names",
              "segmenter",
              "name a list (voc21, coco80, person), or the background and 1 to 255 classes");
}

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

struct MaskedObject {
  SegmentedObject object;
  BoxMask area;
};

/// The size and box of what nearer objects have left of each; too small ones are removed.
void measure_objects(Segmentation& segmentation, int min_pixels) {
  std::vector<SegmentedObject> kept;
  for (std::size_t i = 0; i < segmentation.objects.size(); ++i) {
    SegmentedObject object = segmentation.objects[i];
    const cv::Mat mask = segmentation.instances(object.box) == static_cast<double>(i + 1);
    object.pixels = cv::countNonZero(mask);
    const bool large = object.pixels >= std::max(1, min_pixels);
    segmentation.instances(object.box)
        .setTo(large ? static_cast<double>(kept.size() + 1) : 0, mask);
    if (!large) segmentation.labels(object.box).setTo(0, mask);
    if (!large) continue;
    object.box = cv::boundingRect(mask) + object.box.tl();
    kept.push_back(object);
  }
  segmentation.objects = std::move(kept);
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
  v.choice("cells", cells,
           {{"centres", CellAlignment::kCentres}, {"corners", CellAlignment::kCorners}},
           {.help = "cells tile the input, or the outer ones lie on its corners (align_corners, "
                    "networks of stride 16 with inputs of 16 k + 1)"});
  v("classes", classes,
    {.help = "names by class id, the background first; or one of the lists [voc21], [coco80], "
             "[person]"});
  v("threshold", rule.threshold,
    {.min = 0, .max = 1, .help = "a probability or a box's score below it is background"});
  v("margin", rule.margin, {.help = "lead that a class's logit needs over the background's"});
  v("boxes", boxes, {.help = "how boxes become masks"});
  v("min_object_pixels", min_object_pixels,
    {.min = 1, .unit = "px", .help = "smaller parts of a class are background"});
  v("threads", threads,
    {.min = 0,
     .max = 256,
     .help = "of OpenCV, in the whole process; 0: as many as the runtime gives a stage"});
}

OpenCvDnnSegmenter::OpenCvDnnSegmenter(const Options& options, const StageContext& context)
    : options_(options),
      classes_(class_names(options.classes)),
      network_((use_threads(options.threads, context), options.network),
               options.rule.result == ResultKind::kBoxes) {
  check_outputs();
}

void OpenCvDnnSegmenter::check_outputs() const {
  const std::size_t names = classes_.size();
  for (const cv::Mat& output : network_.trial_outputs()) {
    const auto refuse = [&](const std::string& expected, const std::string& remedy) {
      throw Error(Fault::kUsage, "the output is " + shape_text(output) + ", not " + expected,
                  network_.file(), remedy);
    };
    if (options_.rule.result == ResultKind::kBoxes) {
      if (!holds_boxes(output, names))
        refuse("N x " + std::to_string(names + 4) + " (Darknet, " + std::to_string(names - 1) +
                   " classes) or 1 x 1 x N x 7 (SSD)",
               "check 'result', 'output' and 'classes'");
      continue;
    }
    const std::size_t planes = planes_of(output).size();
    const bool one = options_.rule.result == ResultKind::kProbability ||
                     options_.rule.result == ResultKind::kLogit;
    if (planes == 0) refuse("1 x classes x height x width", "check 'result' and 'output'");
    if (planes != (one ? 1 : names))
      refuse(one ? "1 x 1 x height x width" : "1 x " + std::to_string(names) + " x height x width",
             one ? "check 'result' and 'output'" : "check 'classes', 'result' and 'output'");
    if (one && names != 2)
      throw Error(Fault::kUsage,
                  "one plane of scores needs two names, the background and one class; 'classes' "
                  "has " +
                      std::to_string(names),
                  network_.file(), "correct 'classes', such as [person]");
  }
}

Segmentation OpenCvDnnSegmenter::segment(const Frame& frame) {
  const std::vector<cv::Mat> outputs = network_.run(frame.bgr);
  Segmentation result =
      options_.rule.result == ResultKind::kBoxes
          ? from_boxes(detections(outputs, classes_.size(), options_.rule.threshold,
                                  options_.boxes.overlap),
                       frame)
          : from_scores(outputs.front(), frame.bgr.size());
  result.frame = frame.index;
  return result;
}

Segmentation OpenCvDnnSegmenter::from_scores(const cv::Mat& output, cv::Size image) {
  const std::vector<cv::Mat> planes = planes_of(output);
  if (grid_.image != image)
    grid_ = CellGrid(options_.cells, planes.front().size(), network_.input_size(), image);
  Segmentation result;
  result.labels = label_pixels(competing(planes, options_.rule), grid_);
  find_objects(result, options_.min_object_pixels);
  if (!result.objects.empty())
    score_objects(result, probabilities(planes, options_.rule.result), grid_);
  return result;
}

Segmentation OpenCvDnnSegmenter::from_boxes(const std::vector<Detection>& found,
                                            const Frame& frame) const {
  std::vector<MaskedObject> things;
  for (const Detection& detection : found) {
    const cv::Rect box = pixels_of(detection.box, frame.bgr.size());
    if (box.empty() || things.size() == kMostObjects) continue;
    things.push_back({{.label = detection.label, .box = box, .score = detection.score},
                      box_mask(frame.depth, box, options_.boxes)});
  }
  // Nearer things hide farther ones; those of unknown depth come last.
  std::ranges::stable_sort(things, std::greater{}, [](const MaskedObject& thing) {
    return thing.area.depth > 0 ? thing.area.depth : std::numeric_limits<float>::infinity();
  });
  Segmentation result;
  result.labels = cv::Mat(frame.bgr.size(), CV_8UC1, cv::Scalar(0));
  result.instances = cv::Mat(frame.bgr.size(), CV_8UC1, cv::Scalar(0));
  for (const MaskedObject& thing : things) {
    result.objects.push_back(thing.object);
    result.labels(thing.object.box).setTo(thing.object.label, thing.area.mask);
    result.instances(thing.object.box)
        .setTo(static_cast<double>(result.objects.size()), thing.area.mask);
  }
  measure_objects(result, options_.min_object_pixels);
  return result;
}

}  // namespace stillpoint
