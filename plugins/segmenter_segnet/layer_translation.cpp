#include "segmenter_segnet/layer_translation.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>

#include "segmenter_segnet/caffe_weights.hpp"
#include "segmenter_segnet/unpool_layer.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

using Blobs = std::vector<cv::Mat>;
using Inputs = std::vector<BlobShape>;
using Translation = TranslatedLayer (*)(const LayerDefinition&, const Blobs&, const Inputs&);

constexpr double kBatchNormEpsilon = 1e-5;  // Caffe's default

[[noreturn]] void fail(const LayerDefinition& layer, const std::string& problem,
                       const std::string& remedy = {}) {
  throw Error(Fault::kData, problem, layer.where(), remedy);
}

double number(const LayerDefinition& layer, const TextNode& node) {
  double value = 0;
  const char* end = node.value.data() + node.value.size();
  const auto [stop, fault] = std::from_chars(node.value.data(), end, value);
  if (fault != std::errc() || stop != end)
    fail(layer, "'" + node.name + "' must be a number, not '" + node.value + "'");
  return value;
}

bool is_number(const std::string& text) {
  double value = 0;
  const char* end = text.data() + text.size();
  return std::from_chars(text.data(), end, value).ptr == end && !text.empty();
}

/// OpenCV's layers take Caffe's parameters under their own names.
void copy_parameters(const LayerDefinition& layer, const TextNode& from,
                     cv::dnn::LayerParams& parameters) {
  std::map<std::string, std::vector<double>> numbers;
  for (const TextNode& field : from.fields) {
    if (field.is_message) continue;  // weight fillers, for training only
    if (field.value == "true" || field.value == "false")
      parameters.set(field.name, field.value == "true");
    else if (is_number(field.value))
      numbers[field.name].push_back(number(layer, field));
    else
      parameters.set(field.name, field.value);
  }
  for (const auto& [name, values] : numbers)
    parameters.set(name,
                   cv::dnn::DictValue::arrayReal(values.data(), static_cast<int>(values.size())));
}

std::vector<int> kernel_of(const LayerDefinition& layer, const TextNode& parameters) {
  std::vector<int> sizes;
  for (const TextNode* size : parameters.all("kernel_size")) sizes.push_back(size->as_integer());
  if (sizes.empty()) sizes = {parameters.integer("kernel_h", 0), parameters.integer("kernel_w", 0)};
  if (sizes.size() == 1) sizes.push_back(sizes[0]);
  if (sizes.size() != 2 || sizes[0] < 1 || sizes[1] < 1) fail(layer, "has no kernel size");
  return sizes;
}

void check_count(const LayerDefinition& layer, const Blobs& blobs, std::size_t expected) {
  if (blobs.empty())
    fail(layer, "has no weights in the model file", "do prototxt and model belong together?");
  if (blobs.size() != expected)
    fail(layer, "has " + std::to_string(blobs.size()) +
                    " blobs of weights in the model file, but " + std::to_string(expected) +
                    " are needed");
}

void check_finite(const LayerDefinition& layer, const cv::Mat& blob) {
  const auto* values = blob.ptr<float>();
  if (!std::all_of(values, values + blob.total(), [](float v) { return std::isfinite(v); }))
    fail(layer, "has weights that are not finite", "the model file is damaged");
}

[[noreturn]] void fail_shape(const LayerDefinition& layer, const std::vector<int>& expected,
                             const cv::Mat& blob) {
  fail(layer,
       "needs weights of " + shape_text(expected) + ", but the model file has " +
           shape_text(shape_of(blob)),
       "do prototxt and model belong together?");
}

/// One value per channel, as 1 x n: blobs of old files are 1 x n x 1 x 1 or 1 x 1 x 1 x n.
cv::Mat per_channel(const LayerDefinition& layer, const cv::Mat& blob, int channels) {
  if (blob.total() != static_cast<std::size_t>(channels)) fail_shape(layer, {channels}, blob);
  check_finite(layer, blob);
  return blob.reshape(1, std::vector<int>{1, channels});
}

TranslatedLayer convolution(const LayerDefinition& layer, const Blobs& blobs,
                            const Inputs& inputs) {
  const TextNode& parameters = layer.parameters("convolution_param");
  const std::vector<int> kernel = kernel_of(layer, parameters);
  const int outputs = parameters.integer("num_output", 0);
  const int groups = parameters.integer("group", 1);
  const bool has_bias = parameters.boolean("bias_term", true);
  const int channels = inputs[0].shape[1];
  if (outputs < 1 || groups < 1 || channels % groups || outputs % groups)
    fail(layer, "cannot make " + std::to_string(outputs) + " channels of " +
                    std::to_string(channels) + " in " + std::to_string(groups) + " groups");
  check_count(layer, blobs, has_bias ? 2 : 1);
  const std::vector<int> expected{outputs, channels / groups, kernel[0], kernel[1]};
  if (shape_of(blobs[0]) != expected) fail_shape(layer, expected, blobs[0]);
  check_finite(layer, blobs[0]);

  TranslatedLayer result{.type = "Convolution"};
  copy_parameters(layer, parameters, result.parameters);
  result.parameters.blobs = {blobs[0]};
  if (has_bias) result.parameters.blobs.push_back(per_channel(layer, blobs[1], outputs));
  return result;
}

/// value · scale + shift per channel; OpenCV merges it into the convolution before it.
TranslatedLayer affine(const cv::Mat& scale, const cv::Mat& shift) {
  TranslatedLayer result{.type = "Scale"};
  result.parameters.set("bias_term", true);
  result.parameters.blobs = {scale, shift};
  return result;
}

/// SegNet's own normalisation. In mode INFERENCE its blobs are the scale and the shift that are
/// left once the statistics of the training images are merged into them.
TranslatedLayer segnet_normalisation(const LayerDefinition& layer, const Blobs& blobs,
                                     const Inputs& inputs) {
  if (layer.parameters("bn_param").text("bn_mode", "LEARN") != "INFERENCE")
    fail(layer, "is in the mode for training",
         "use weights with merged statistics (compute_bn_statistics.py of the SegNet tutorial) and "
         "a prototxt with 'bn_mode: INFERENCE'");
  check_count(layer, blobs, 2);
  const int channels = inputs[0].shape[1];
  return affine(per_channel(layer, blobs[0], channels), per_channel(layer, blobs[1], channels));
}

/// Caffe's own: mean and variance, both times the factor in the third blob.
TranslatedLayer batch_normalisation(const LayerDefinition& layer, const Blobs& blobs,
                                    const Inputs& inputs) {
  const TextNode& parameters = layer.parameters("batch_norm_param");
  if (!parameters.boolean("use_global_stats", true))
    fail(layer, "is in the mode for training", "set use_global_stats: true");
  const TextNode* eps = parameters.find("eps");
  const double epsilon = eps ? number(layer, *eps) : kBatchNormEpsilon;
  check_count(layer, blobs, 3);
  const int channels = inputs[0].shape[1];
  const double factor = per_channel(layer, blobs[2], 1).at<float>(0);
  const double inverse = factor == 0.0 ? 0.0 : 1.0 / factor;
  cv::Mat scale, shift;
  cv::sqrt(per_channel(layer, blobs[1], channels) * inverse + epsilon, scale);
  scale = 1.0 / scale;
  shift = per_channel(layer, blobs[0], channels).mul(scale, -inverse);
  return affine(scale, shift);
}

TranslatedLayer scale(const LayerDefinition& layer, const Blobs& blobs, const Inputs& inputs) {
  const TextNode& parameters = layer.parameters("scale_param");
  const bool has_bias = parameters.boolean("bias_term", false);
  if (layer.bottoms.size() != 1 || parameters.integer("axis", 1) != 1 ||
      parameters.integer("num_axes", 1) != 1)
    fail(layer, "scales by something else than one number per channel, which is not supported");
  check_count(layer, blobs, has_bias ? 2 : 1);
  const int channels = inputs[0].shape[1];
  return affine(per_channel(layer, blobs[0], channels),
                has_bias ? per_channel(layer, blobs[1], channels)
                         : cv::Mat(1, channels, CV_32F, cv::Scalar(0)));
}

TranslatedLayer relu(const LayerDefinition& layer, const Blobs&, const Inputs&) {
  TranslatedLayer result{.type = "ReLU"};
  copy_parameters(layer, layer.parameters("relu_param"), result.parameters);
  return result;
}

TranslatedLayer pooling(const LayerDefinition& layer, const Blobs&, const Inputs&) {
  const TextNode& parameters = layer.parameters("pooling_param");
  const std::string method = parameters.text("pool", "MAX");
  if (layer.tops.size() == 2 && method != "MAX" && method != "0")
    fail(layer, "gives a mask, which only pooling by MAX can");
  if (!parameters.boolean("global_pooling", false)) kernel_of(layer, parameters);
  TranslatedLayer result{.type = "Pooling"};
  copy_parameters(layer, parameters, result.parameters);
  result.parameters.set("pool", method == "0" ? "MAX" : method);
  return result;
}

TranslatedLayer response_normalisation(const LayerDefinition& layer, const Blobs&, const Inputs&) {
  TranslatedLayer result{.type = "LRN"};
  copy_parameters(layer, layer.parameters("lrn_param"), result.parameters);
  return result;
}

/// The size that caffe-segnet gives: upsample_h and upsample_w, or else by the older scale factors.
TranslatedLayer upsample(const LayerDefinition& layer, const Blobs&, const Inputs& inputs) {
  const TextNode& parameters = layer.parameters("upsample_param");
  if (inputs.size() != 2 || inputs[1].pooled.empty())
    fail(layer, "needs two bottoms: values, and the mask of a pooling layer");
  if (inputs[0].shape != inputs[1].shape)
    fail(layer, "has values of " + shape_text(inputs[0].shape) + " but a mask of " +
                    shape_text(inputs[1].shape));
  const auto size = [&](const std::string& axis, int input) {
    const int factor = parameters.integer("scale" + axis, parameters.integer("scale", 2));
    return input * factor - static_cast<int>(parameters.boolean("pad_out" + axis, false));
  };
  const std::vector<int>& values = inputs[0].shape;
  std::vector<int> output{values[0], values[1], size("_h", values[2]), size("_w", values[3])};
  if (parameters.find("upsample_h") && parameters.find("upsample_w"))
    output = {values[0], values[1], parameters.integer("upsample_h", 0),
              parameters.integer("upsample_w", 0)};
  // With another width Caffe would silently put values into the wrong places.
  if (output != inputs[1].pooled)
    fail(layer,
         "makes " + shape_text(output) + " of what was pooled from " + shape_text(inputs[1].pooled),
         "set upsample_h: " + std::to_string(inputs[1].pooled[2]) +
             " and upsample_w: " + std::to_string(inputs[1].pooled[3]));
  TranslatedLayer result{.type = UnpoolLayer::kType};
  result.parameters.set("output_height", output[2]);
  result.parameters.set("output_width", output[3]);
  return result;
}

TranslatedLayer identity(const LayerDefinition&, const Blobs&, const Inputs&) { return {}; }

const std::map<std::string, Translation>& translations() {
  static const std::map<std::string, Translation> kTranslations = {
      {"ArgMax", identity},
      {"BN", segnet_normalisation},
      {"BatchNorm", batch_normalisation},
      {"Convolution", convolution},
      {"Dropout", identity},
      {"LRN", response_normalisation},
      {"Pooling", pooling},
      {"ReLU", relu},
      {"Scale", scale},
      {"Softmax", identity},
      {"Upsample", upsample}};
  return kTranslations;
}

}  // namespace

TranslatedLayer translate(const LayerDefinition& layer, const std::vector<cv::Mat>& blobs,
                          const std::vector<BlobShape>& inputs) {
  const auto found = translations().find(layer.type);
  if (found != translations().end()) return found->second(layer, blobs, inputs);
  std::vector<std::string> types;
  for (const auto& [type, translation] : translations()) types.push_back(type);
  fail(layer, "has the unsupported type '" + layer.type + "'" + did_you_mean(layer.type, types),
       "SegNet's layers are " + join(types) + "; layers for training belong into another prototxt");
}

bool reads_scores(const LayerDefinition& layer) {
  return layer.type == "ArgMax" || layer.type == "Softmax";
}

}  // namespace stillpoint::segmenter_segnet
