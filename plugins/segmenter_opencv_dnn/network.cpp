#include "segmenter_opencv_dnn/network.hpp"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "segmenter_opencv_dnn/network_file.hpp"
#include "segmenter_opencv_dnn/quiet_opencv.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "stillpoint/support/exposure.hpp"
#include "stillpoint/support/model_lookup.hpp"
#include "stillpoint/support/size_text.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

constexpr double kMostGain = 16;  // of an image that is nearly black, noise would be people
const char kOwnCode = 0;          // its address identifies this library, beside which models lie

double of_channel(const std::vector<double>& values, int channel) {
  return values.size() == 1 ? values[0] : values[static_cast<std::size_t>(channel)];
}

std::vector<std::string> chosen_outputs(const cv::dnn::Net& net, const NetworkOptions& options,
                                        const std::string& file, bool all) {
  const std::vector<std::string> open = net.getUnconnectedOutLayersNames();
  if (options.output.empty()) {
    if (all || open.size() == 1) return open;
    throw Error(Fault::kUsage, "the network has several outputs: " + join(open), file,
                "name one of them as 'output'");
  }
  std::vector<std::string> layers = net.getLayerNames();
  layers.insert(layers.end(), open.begin(), open.end());
  if (std::ranges::find(layers, options.output) != layers.end()) return {options.output};
  throw Error(Fault::kUsage,
              "the network has no output '" + options.output + "'" +
                  did_you_mean(options.output, layers) + "; it ends in: " + join(open),
              file, "correct 'output'");
}

/// Weights that are not finite would give NaN scores, which lose every comparison.
void check_finite(cv::dnn::Net& net, const std::string& file) {
  for (const std::string& name : net.getLayerNames()) {
    for (const cv::Mat& weights : net.getLayer(net.getLayerId(name))->blobs) {
      if (cv::checkRange(weights)) continue;
      throw Error(Fault::kData, "the weights of layer '" + name + "' are not all finite numbers",
                  file, "the file is damaged; get it again");
    }
  }
}

/// Factor for an image whose brightest percent is darker than `level`.
double brightening(const cv::Mat& image, int level) {
  if (level == 0) return 1;
  const int brightest = level_quantile(image, kNotBrightest);
  return brightest == 0 ? 1 : std::clamp(static_cast<double>(level) / brightest, 1.0, kMostGain);
}

}  // namespace

void NetworkOptions::visit(OptionVisitor& v) {
  v("model", model,
    {.help = "file of the network: .onnx, .caffemodel, .pb or .weights", .is_path = true});
  v("config", config, {.help = "its .prototxt, .pbtxt or .cfg file", .is_path = true});
  v("width", width, {.min = 1, .max = 8192, .unit = "px", .help = "width of the network's input"});
  v("height", height,
    {.min = 1, .max = 8192, .unit = "px", .help = "height of the network's input"});
  v("scale", scale,
    {.help = "the input is scale * (pixel - mean); one number, or one per channel"});
  v("mean", mean, {.help = "one number, or one per channel, in the network's order"});
  v.choice("channels", channels, {{"rgb", ChannelOrder::kRgb}, {"bgr", ChannelOrder::kBgr}},
           {.help = "order of the input's channels"});
  v("output", output, {.help = "name of the output; empty: the only one"});
  v("brighten_to", brighten_to,
    {.min = 0,
     .max = 255,
     .unit = "grey levels",
     .help = "a dark image is brightened until its brightest percent has this level; 0: never"});
  v.require(scale.size() == 1 || scale.size() == 3, "'scale' needs one or three numbers");
  v.require(mean.size() == 1 || mean.size() == 3, "'mean' needs one or three numbers");
}

Network::Network(const NetworkOptions& options, bool all_outputs)
    : options_(options), file_(find_model(options.model, &kOwnCode).string()) {
  const std::string config =
      options.config.empty() ? "" : find_model(options.config, &kOwnCode).string();
  net_ = read_network(file_, config);
  const QuietOpenCv quiet;
  outputs_ = chosen_outputs(net_, options_, file_, all_outputs);
  try {
    for (const cv::Mat& output : forward(cv::Mat(input_size(), CV_8UC3, cv::Scalar::all(0))))
      trial_outputs_.push_back(output.clone());
  } catch (const cv::Exception& exception) {
    throw Error(
        Fault::kData,
        "the network fails on a black image of " + size_text(input_size()) + ": " +
            reason(exception),
        file_,
        "check 'width' and 'height'; or the file is damaged or uses layers that OpenCV " CV_VERSION
        " does not have");
  }
  check_finite(net_, file_);
}

std::vector<cv::Mat> Network::run(const cv::Mat& bgr) {
  const QuietOpenCv quiet;
  try {
    std::vector<cv::Mat> outputs = forward(bgr);
    if (std::ranges::all_of(outputs, [](const cv::Mat& m) { return cv::checkRange(m); }))
      return outputs;
  } catch (const cv::Exception& exception) {
    throw Error(Fault::kStage, "the network failed: " + reason(exception), file_);
  }
  throw Error(Fault::kStage, "the network's outputs are not all finite numbers", file_,
              "check 'scale' and 'mean'");
}

/// As cv::dnn::blobFromImage, but with a scale per channel, and in a third of its time.
cv::Mat Network::input(const cv::Mat& bgr) {
  cv::Mat stretched;
  cv::resize(bgr, stretched, input_size());
  gain_ = brightening(stretched, options_.brighten_to);
  const int shape[] = {1, 3, options_.height, options_.width};
  cv::Mat blob(4, shape, CV_32FC1);
  for (int i = 0; i < 3; ++i) {
    cv::Mat channel;
    cv::extractChannel(stretched, channel, options_.channels == ChannelOrder::kRgb ? 2 - i : i);
    const double scale = of_channel(options_.scale, i);
    cv::Mat plane(input_size(), CV_32FC1, blob.ptr<float>(0, i));
    channel.convertTo(plane, CV_32F, gain_ * scale, -scale * of_channel(options_.mean, i));
  }
  return blob;
}

std::vector<cv::Mat> Network::forward(const cv::Mat& bgr) {
  net_.setInput(input(bgr));
  std::vector<cv::Mat> outputs;
  net_.forward(outputs, outputs_);
  return outputs;
}

}  // namespace stillpoint::segmenter_opencv_dnn
