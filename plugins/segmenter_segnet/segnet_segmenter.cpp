#include "segmenter_segnet/segnet_segmenter.hpp"

#include <opencv2/core/utility.hpp>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "segmenter_segnet/class_picking.hpp"
#include "stillpoint/support/model_lookup.hpp"
#include "stillpoint/support/objects.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

const char kOwnCode = 0;  // its address identifies this library, beside which models may lie

void check_classes(int channels, const ClassNames& classes, const std::string& prototxt) {
  if (static_cast<std::size_t>(channels) == classes.size()) return;
  throw Error(Fault::kUsage,
              "the network tells " + std::to_string(channels) +
                  " classes apart, but 'classes' has " + std::to_string(classes.size()) + " names",
              prototxt, "name the classes of this network, the first one for its channel 0");
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
  v("classes", classes,
    {.help = "names by class id; or one of the lists [voc21], [coco80], [person]"});
  v.choice("channels", channels, {{"bgr", ChannelOrder::kBgr}, {"rgb", ChannelOrder::kRgb}},
           {.help = "order of the input's channels"});
  v("mean", mean, {.help = "one number, or one per channel, in the network's order"});
  v("scale", scale, {.min = 1e-6, .help = "the input is scale * (pixel - mean)"});
  v("min_object_pixels", min_object_pixels,
    {.min = 1, .unit = "px", .help = "smaller parts of a class are background"});
  v("threads", threads,
    {.min = 0,
     .max = 256,
     .help = "threads of OpenCV, in the whole process; 0: as many as the runtime gives a stage"});
  v.require(mean.size() == 1 || mean.size() == 3, "'mean' needs one or three numbers");
}

SegnetSegmenter::SegnetSegmenter(Options options, const StageContext& context)
    : options_(std::move(options)),
      classes_(classes_of(options_.classes)),
      network_(find_model(options_.prototxt, &kOwnCode), find_model(options_.model, &kOwnCode)) {
  check_classes(network_.channels(), classes_, options_.prototxt);
  cv::setNumThreads(options_.threads > 0 ? options_.threads : context.threads);
}

Segmentation SegnetSegmenter::segment(const Frame& frame) {
  const PickedClasses picked = pick_classes(scores(frame.bgr));
  Segmentation result{.labels = enlarged(picked.labels, frame.bgr.size()), .frame = frame.index};
  find_objects(result, options_.min_object_pixels);
  score_objects(result, enlarged(picked.probability, frame.bgr.size()));
  return result;
}

cv::Mat SegnetSegmenter::scores(const cv::Mat& bgr) {
  const std::vector<double>& given = options_.mean;
  const cv::Scalar mean =
      given.size() == 1 ? cv::Scalar::all(given[0]) : cv::Scalar(given[0], given[1], given[2]);
  const bool swap = options_.channels == ChannelOrder::kRgb;
  try {
    cv::Mat scores = network_.scores(
        cv::dnn::blobFromImage(bgr, options_.scale, network_.input_size(), mean, swap, false));
    if (cv::checkRange(scores)) return scores;
  } catch (const cv::Exception& failure) {
    throw Error(Fault::kStage, "OpenCV DNN failed: " + failure.err, options_.prototxt);
  }
  throw Error(Fault::kStage, "its scores are not finite", options_.prototxt);
}

}  // namespace stillpoint::segmenter_segnet
