#include "segmenter_segnet/segnet_network.hpp"

#include <map>
#include <utility>

#include "segmenter_segnet/caffe_weights.hpp"
#include "segmenter_segnet/layer_translation.hpp"
#include "segmenter_segnet/unpool_layer.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

/// A blob of the network, and which output of which layer of OpenCV's holds it.
struct Blob {
  BlobShape shape;
  int layer = 0;
  int output = 0;
  bool after_scores = false;  // after a softmax or argmax, which is replaced by its input
};

/// Adds the layers of a definition one after the other.
class NetworkBuilder {
 public:
  NetworkBuilder(const NetworkDefinition& network, const CaffeWeights& weights)
      : input_shape_(network.shape), weights_(weights) {
    UnpoolLayer::register_type();
    net_.setInputsNames({network.input});
    blobs_[network.input] = {.shape = {.shape = input_shape_}};
    for (const LayerDefinition& layer : network.layers) {
      try {
        add(layer);
      } catch (const cv::Exception& refusal) {
        fail(layer, "OpenCV refuses it: " + refusal.err);
      }
    }
  }

  cv::dnn::Net net() const { return net_; }
  /// Of the last layer: the scores.
  const Blob& output() const { return blobs_.at(last_top_); }

 private:
  void add(const LayerDefinition& layer) {
    const std::vector<Blob> inputs = inputs_of(layer);
    std::vector<BlobShape> shapes;
    shapes.reserve(inputs.size());
    for (const Blob& input : inputs) shapes.push_back(input.shape);
    const auto found = weights_.find(layer.name);
    TranslatedLayer translated =
        translate(layer, found == weights_.end() ? std::vector<cv::Mat>{} : found->second, shapes);
    last_top_ = layer.tops.front();
    if (translated.is_identity()) {
      blobs_[last_top_] = inputs.front();
      blobs_[last_top_].after_scores = inputs.front().after_scores || reads_scores(layer);
    } else {
      connect(layer, translated, inputs);
    }
  }

  std::vector<Blob> inputs_of(const LayerDefinition& layer) const {
    if (layer.bottoms.empty()) fail(layer, "has no bottom");
    std::vector<Blob> inputs;
    for (const std::string& bottom : layer.bottoms) {
      const auto found = blobs_.find(bottom);
      if (found == blobs_.end())
        fail(layer, "reads '" + bottom + "', which no layer before it writes" + suggestion(bottom));
      if (found->second.after_scores && !reads_scores(layer))
        fail(layer, "comes after the scores of the network, which is not supported");
      inputs.push_back(found->second);
    }
    return inputs;
  }

  void connect(const LayerDefinition& layer, TranslatedLayer& translated,
               const std::vector<Blob>& inputs) {
    const int id = net_.addLayer(layer.name, translated.type, translated.parameters);
    for (std::size_t i = 0; i < inputs.size(); ++i)
      net_.connect(inputs[i].layer, inputs[i].output, id, static_cast<int>(i));
    const std::vector<std::vector<int>> shapes = output_shapes(layer, id);
    for (std::size_t i = 0; i < layer.tops.size(); ++i) {
      if (i >= shapes.size()) fail(layer, "has too many tops");
      Blob& top = blobs_[layer.tops[i]] = {
          .shape = {.shape = shapes[i]}, .layer = id, .output = static_cast<int>(i)};
      if (i == 1) top.shape.pooled = inputs.front().shape.shape;
    }
  }

  std::vector<std::vector<int>> output_shapes(const LayerDefinition& layer, int id) {
    std::vector<cv::dnn::MatShape> in, out;
    net_.getLayerShapes(input_shape_, id, in, out);
    for (const auto& shape : out)
      if (shape.size() != 4 || shape[2] < 1 || shape[3] < 1) fail(layer, "leaves no image");
    return out;
  }

  std::string suggestion(const std::string& blob) const {
    std::vector<std::string> names;
    for (const auto& [name, known] : blobs_) names.push_back(name);
    return did_you_mean(blob, names);
  }
  [[noreturn]] static void fail(const LayerDefinition& layer, const std::string& problem) {
    throw Error(Fault::kData, problem, layer.where());
  }

  cv::dnn::Net net_;
  std::vector<int> input_shape_;
  const CaffeWeights& weights_;
  std::map<std::string, Blob> blobs_;
  std::string last_top_;
};

}  // namespace

SegnetNetwork::SegnetNetwork(const std::filesystem::path& prototxt,
                             const std::filesystem::path& model) {
  const NetworkDefinition definition = read_definition(prototxt);
  const CaffeWeights weights = read_caffe_weights(model);
  const NetworkBuilder builder(definition, weights);
  net_ = builder.net();
  net_.setPreferableBackend(cv::dnn::DNN_BACKEND_OPENCV);
  net_.setPreferableTarget(cv::dnn::DNN_TARGET_CPU);
  input_shape_ = definition.shape;
  output_shape_ = builder.output().shape.shape;
  output_ = net_.getLayer(builder.output().layer)->name;
}

cv::Mat SegnetNetwork::scores(const cv::Mat& image) {
  net_.setInput(image);
  return net_.forward(output_);
}

}  // namespace stillpoint::segmenter_segnet
