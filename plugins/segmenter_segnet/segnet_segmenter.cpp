#include "segmenter_segnet/segnet_segmenter.hpp"

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "segmenter_segnet/class_picking.hpp"
#include "stillpoint/objects.hpp"

namespace stillpoint {
namespace {

constexpr std::size_t kMostClasses = 256;  // labels are 8-bit

ClassNames classes_of(const SegnetSegmenter::Options& options) {
  return options.class_names.empty() ? named_classes(options.classes) : options.class_names;
}

void check_classes(int channels, const SegnetSegmenter::Options& options,
                   const ClassNames& classes) {
  const std::string list =
      options.class_names.empty() ? "the list '" + options.classes + "'" : "class_names";
  if (classes.size() > kMostClasses)
    throw Error(Fault::kUsage, list + " has more than 256 classes");
  if (static_cast<std::size_t>(channels) == classes.size()) return;
  throw Error(Fault::kUsage,
              "the network tells " + std::to_string(channels) + " classes apart, but " + list +
                  " has " + std::to_string(classes.size()),
              options.prototxt, "name the network's classes with 'classes' or 'class_names'");
}

cv::Mat enlarged(const cv::Mat& image, cv::Size size) {
  cv::Mat result;
  cv::resize(image, result, size, 0, 0, cv::INTER_NEAREST_EXACT);  // exact: centres of pixels
  return result;
}

}  // namespace

void SegnetSegmenter::Options::visit(OptionVisitor& v) {
  v("prototxt", prototxt,
    {.help = "the network's definition for inference", .required = true, .is_path = true});
  v("model", model, {.help = "its weights, a .caffemodel", .required = true, .is_path = true});
  v("classes", classes, {.help = "list of what the labels mean: voc21, coco80 or person"});
  v("class_names", class_names, {.help = "instead of a list: the names, the first one is label 0"});
  v.choice("channel_order", channel_order,
           {{"bgr", ChannelOrder::kBgr}, {"rgb", ChannelOrder::kRgb}},
           {.help = "of the network's input"});
  v("mean", mean, {.help = "subtracted from the three channels, in the network's order"});
  v("scale", scale, {.min = 1e-6, .help = "multiplies the channels (0 to 255) after that"});
  v("min_object_pixels", min_object_pixels,
    {.min = 1, .unit = "px", .help = "smaller objects become background"});
  v.require(mean.size() == 3, "mean needs three numbers");
}

SegnetSegmenter::SegnetSegmenter(Options options, const StageContext& context)
    : options_(std::move(options)),
      classes_(classes_of(options_)),
      network_(options_.prototxt, options_.model) {
  check_classes(network_.channels(), options_, classes_);
  cv::setNumThreads(context.threads);  // of all that OpenCV does in this process
}

Segmentation SegnetSegmenter::segment(const Frame& frame) {
  const segnet::PickedClasses picked = segnet::pick_classes(scores(frame.bgr));
  Segmentation result{.labels = enlarged(picked.labels, frame.bgr.size()), .frame = frame.index};
  find_objects(result, options_.min_object_pixels);
  segnet::score_objects(result, enlarged(picked.probability, frame.bgr.size()));
  return result;
}

cv::Mat SegnetSegmenter::scores(const cv::Mat& bgr) {
  const cv::Scalar mean(options_.mean[0], options_.mean[1], options_.mean[2]);
  const bool swap = options_.channel_order == ChannelOrder::kRgb;
  try {
    return network_.scores(
        cv::dnn::blobFromImage(bgr, options_.scale, network_.input_size(), mean, swap, false));
  } catch (const cv::Exception& failure) {
    throw Error(Fault::kStage, "OpenCV DNN failed: " + failure.err, options_.prototxt);
  }
}

}  // namespace stillpoint
