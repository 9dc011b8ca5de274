#include "segmenter_opencv_dnn/network_file.hpp"

#include <array>
#include <filesystem>
#include <regex>
#include <string_view>

#include "segmenter_opencv_dnn/quiet_opencv.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::segmenter_opencv_dnn {
namespace {

namespace fs = std::filesystem;

constexpr std::uintmax_t kLargestModel = 2047 << 20;  // bytes, as protobuf has it

struct Kind {
  std::string_view suffix;  // of the model
  std::string_view config;  // suffix of the other file
  bool needs_config;
  std::string_view name;
};

constexpr std::array kKinds = {Kind{".onnx", "", false, "an ONNX network"},
                               Kind{".caffemodel", ".prototxt", true, "a Caffe network"},
                               Kind{".pb", ".pbtxt", false, "a TensorFlow network"},
                               Kind{".weights", ".cfg", true, "a Darknet network"}};

const Kind& kind_of(const std::string& model) {
  for (const Kind& kind : kKinds)
    if (fs::path(model).extension() == kind.suffix) return kind;
  throw Error(Fault::kUsage, "this is no kind of network that can be read", model,
              "give an .onnx, .caffemodel (with its .prototxt), .pb or .weights file (with its "
              ".cfg)");
}

void check_config(const Kind& kind, const std::string& model, const std::string& config) {
  const std::string name(kind.name);
  if (config.empty() && kind.needs_config)
    throw Error(Fault::kUsage, name + " consists of two files", model,
                "name its " + std::string(kind.config) + " file as 'config'");
  if (!config.empty() && kind.config.empty())
    throw Error(Fault::kUsage, name + " is a single file", config, "leave 'config' out");
  if (!config.empty() && fs::path(config).extension() != kind.config)
    throw Error(Fault::kUsage, "this does not belong to " + name, config,
                "name its " + std::string(kind.config) + " file as 'config'");
}

/// OpenCV reads a truncated file without an error and leaves the missing weights uninitialised.
void check_darknet_size(cv::dnn::Net& net, const std::string& model) {
  constexpr std::uintmax_t kSmallestHeader = 16;  // bytes
  std::uintmax_t needed = kSmallestHeader;
  for (const std::string& name : net.getLayerNames()) {
    const cv::Ptr<cv::dnn::Layer> layer = net.getLayer(net.getLayerId(name));
    if (layer->type == "Region") continue;  // its anchors come from the .cfg
    for (const cv::Mat& blob : layer->blobs) needed += blob.total() * blob.elemSize();
  }
  const std::uintmax_t size = fs::file_size(model);
  if (size >= needed) return;
  throw Error(Fault::kData,
              "the file is truncated: it has " + std::to_string(size) + " bytes, the network of " +
                  "its .cfg needs " + std::to_string(needed),
              model, "get the file again, or the .cfg that belongs to it");
}

}  // namespace

std::string reason(const cv::Exception& exception) {
  std::string text = exception.err.empty() ? exception.what() : exception.err;
  static const std::regex kUnknownLayer(R"re(of type "([^"]+)"|[Uu]nknown layer type: (\S+))re");
  static const std::regex kFailingLayer(R"re(Node \[([^@\]]+)@[^\]]*\]:\(([^)]*)\))re");
  std::smatch match;
  if (std::regex_search(text, match, kUnknownLayer))
    return "unsupported layer '" + (match[1].matched ? match[1] : match[2]).str() + "'";
  if (const auto end = text.find('\n'); end != std::string::npos) text.resize(end);
  if (std::regex_search(text, match, kFailingLayer))
    return "layer '" + match[2].str() + "' of kind " + match[1].str() + ": " + text;
  return text;
}

cv::dnn::Net read_network(const std::string& model, const std::string& config) {
  const Kind& kind = kind_of(model);
  check_config(kind, model, config);
  input_file_size(model, kLargestModel);
  if (!config.empty()) input_file_size(config, kLargestText);
  const QuietOpenCv quiet;
  try {
    cv::dnn::Net net = cv::dnn::readNet(model, config);
    if (net.empty()) throw Error(Fault::kData, "the network has no layers", model);
    if (kind.suffix == ".weights") check_darknet_size(net, model);
    return net;
  } catch (const cv::Exception& exception) {
    throw Error(Fault::kData,
                "this cannot be read as " + std::string(kind.name) + ": " + reason(exception),
                model,
                "the file is truncated, of another kind, or uses layers that OpenCV " CV_VERSION
                " does not have");
  }
}

}  // namespace stillpoint::segmenter_opencv_dnn
