// SegNets with random weights, and their files: a .prototxt and a .caffemodel as Caffe writes them.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

namespace stillpoint::segmenter_segnet {

struct TestBlob {
  std::vector<int> shape;
  std::vector<float> values;
};

struct TestLayer {
  std::string name;
  std::string type;
  std::vector<std::string> bottoms;
  std::vector<std::string> tops;
  std::string parameters;  ///< text of the prototxt
  std::vector<TestBlob> blobs;
  int pad = 0;        ///< Convolution
  cv::Size unpooled;  ///< Upsample: size of its output
};

/// Protocol buffers in binary form.
class MessageWriter {
 public:
  MessageWriter& varint(int field, std::uint64_t value) {
    key(field, 0);
    number(value);
    return *this;
  }
  MessageWriter& bytes(int field, const std::string& value) {
    key(field, 2);
    number(value.size());
    text_ += value;
    return *this;
  }
  MessageWriter& packed_floats(int field, const std::vector<float>& values) {
    return bytes(field, {reinterpret_cast<const char*>(values.data()), values.size() * 4});
  }
  MessageWriter& single_float(int field, float value) {
    key(field, 5);
    text_.append(reinterpret_cast<const char*>(&value), 4);
    return *this;
  }
  MessageWriter& packed_varints(int field, const std::vector<int>& values) {
    MessageWriter list;
    for (const int value : values) list.number(static_cast<std::uint64_t>(value));
    return bytes(field, list.text_);
  }
  const std::string& text() const { return text_; }

 private:
  void key(int field, int type) { number(static_cast<std::uint64_t>(field << 3 | type)); }
  void number(std::uint64_t value) {
    for (; value >= 0x80; value >>= 7) text_ += static_cast<char>(value | 0x80);
    text_ += static_cast<char>(value);
  }

  std::string text_;
};

enum class ModelFormat { kToday, kV1 };

/// Layers are added one after the other; each reads what the one before it wrote.
class TestNetwork {
 public:
  TestNetwork(int height, int width, std::uint64_t seed)
      : height_(height), width_(width), channels_(3), current_(width, height), random_(seed) {}

  /// Weights of −2 … 2 and other whole numbers, so that all arithmetic is exact and ties are real.
  TestNetwork& whole_numbers() {
    whole_numbers_ = true;
    return *this;
  }
  TestNetwork& convolution(const std::string& name, int outputs, int kernel, bool bias = true) {
    TestLayer& layer = add(name, "Convolution", name);
    layer.pad = kernel / 2;
    layer.parameters = "param {\n    lr_mult: 1\n    decay_mult: 1\n  }\n  convolution_param {\n" +
                       std::string("    weight_filler {\n      type: \"msra\"\n    }\n") +
                       "    num_output: " + std::to_string(outputs) +
                       "\n    pad: " + std::to_string(layer.pad) +
                       "\n    kernel_size: " + std::to_string(kernel) +
                       (bias ? "" : "\n    bias_term: false") + "\n  }\n";
    const double spread = std::sqrt(2.0 / (channels_ * kernel * kernel));
    layer.blobs = {blob({outputs, channels_, kernel, kernel}, 0, spread)};
    if (bias) layer.blobs.push_back(blob({outputs}, 0, 0.1));
    channels_ = outputs;
    return *this;
  }
  TestNetwork& bn(const std::string& name) {
    TestLayer& layer = add(name, "BN", top_);
    layer.parameters =
        "bn_param {\n\tbn_mode: INFERENCE\n\tscale_filler {\n\t  type: \"constant\"\n\t  value: 1\n"
        "\t}\n\tshift_filler {\n\t  type: \"constant\"\n\t  value: 0.001\n\t}\n }\n";
    layer.blobs = {blob({1, channels_, 1, 1}, 1, 0.3), blob({1, channels_, 1, 1}, 0, 0.3)};
    return *this;
  }
  TestNetwork& batch_norm(const std::string& name) {
    TestLayer& layer = add(name, "BatchNorm", top_);
    layer.parameters = "batch_norm_param { use_global_stats: true eps: 1e-3 }\n";
    layer.blobs = {blob({channels_}, 0, 0.5), blob({channels_}, 0, 1), {{1}, {2.5f}}};
    for (float& variance : layer.blobs[1].values) variance = std::abs(variance) + 0.1f;
    return *this;
  }
  TestNetwork& scale(const std::string& name) {
    TestLayer& layer = add(name, "Scale", top_);
    layer.parameters = "scale_param { bias_term: true }\n";
    layer.blobs = {blob({channels_}, 1, 0.3), blob({channels_}, 0, 0.3)};
    return *this;
  }
  /// Layers without weights: ReLU, Dropout (in place), LRN, Softmax, ArgMax.
  TestNetwork& plain(const std::string& type, const std::string& name, bool in_place,
                     const std::string& parameters = {}) {
    const std::string top = in_place ? top_ : name;
    add(name, type, top).parameters = parameters;
    return *this;
  }
  TestNetwork& relu(const std::string& name) { return plain("ReLU", name, true); }
  TestNetwork& pool(const std::string& name) {
    TestLayer& layer = add(name, "Pooling", name);
    layer.tops.push_back(name + "_mask");
    layer.parameters = "pooling_param {\n    pool: MAX\n    kernel_size: 2\n    stride: 2\n  }\n";
    pooled_.push_back(current_);
    current_ = {(current_.width + 1) / 2, (current_.height + 1) / 2};
    return *this;
  }
  /// `parameters` are those of upsample_param; without any, the size of what was pooled.
  TestNetwork& upsample(const std::string& name, const std::string& pool,
                        std::string parameters = {}) {
    TestLayer& layer = add(name, "Upsample", name);
    layer.bottoms.push_back(pool + "_mask");
    layer.unpooled = current_ = pooled_.back();
    pooled_.pop_back();
    if (parameters.empty())
      parameters = "scale: 2 upsample_w: " + std::to_string(current_.width) +
                   " upsample_h: " + std::to_string(current_.height);
    layer.parameters = "upsample_param { " + parameters + " }\n";
    return *this;
  }

  std::vector<TestLayer>& layers() { return layers_; }
  const std::vector<TestLayer>& layers() const { return layers_; }
  TestLayer& layer(const std::string& name) {
    for (TestLayer& layer : layers_)
      if (layer.name == name) return layer;
    throw std::out_of_range(name);
  }
  int channels() const { return channels_; }

  /// A picture for the input: 1 x 3 x height x width.
  cv::Mat image() {
    const std::vector<int> shape{1, 3, height_, width_};
    cv::Mat image(4, shape.data(), CV_32F);
    random_.fill(image, cv::RNG::UNIFORM, 0.0, whole_numbers_ ? 4.0 : 1.0);
    if (whole_numbers_)
      for (std::size_t i = 0; i < image.total(); ++i)
        image.ptr<float>()[i] = std::floor(image.ptr<float>()[i]);
    return image;
  }

  std::string prototxt() const {
    std::string text = "name: \"segnet\"  # as published\ninput: \"data\"\ninput_dim: 1\n";
    text += "input_dim: 3\ninput_dim: " + std::to_string(height_) + "\n";
    text += "input_dim: " + std::to_string(width_) + "\n";
    for (const TestLayer& layer : layers_) {
      text += "layer {\n  name: \"" + layer.name + "\"\n  type: \"" + layer.type + "\"\n";
      for (const std::string& bottom : layer.bottoms) text += "  bottom: \"" + bottom + "\"\n";
      for (const std::string& top : layer.tops) text += "  top: \"" + top + "\"\n";
      text += "  " + layer.parameters + "}\n";
    }
    return text;
  }

  std::string caffemodel(ModelFormat format = ModelFormat::kToday) const {
    MessageWriter network;
    network.bytes(1, "segnet");
    for (const TestLayer& layer : layers_)
      network.bytes(format == ModelFormat::kV1 ? 2 : 100, layer_message(layer, format));
    return network.text();
  }

 private:
  TestLayer& add(const std::string& name, const std::string& type, const std::string& top) {
    layers_.push_back({.name = name, .type = type, .bottoms = {top_}, .tops = {top}});
    top_ = top;
    return layers_.back();
  }

  TestBlob blob(std::vector<int> shape, double mean, double spread) {
    std::size_t count = 1;
    for (const int size : shape) count *= static_cast<std::size_t>(size);
    cv::Mat values(1, static_cast<int>(count), CV_32F);
    if (whole_numbers_) {
      cv::Mat numbers(values.size(), CV_32S);
      random_.fill(numbers, cv::RNG::UNIFORM, -2, 3);
      numbers.convertTo(values, CV_32F);
    } else {
      random_.fill(values, cv::RNG::NORMAL, mean, spread);
    }
    return {std::move(shape), std::vector<float>(values.begin<float>(), values.end<float>())};
  }

  static std::string layer_message(const TestLayer& layer, ModelFormat format) {
    const bool v1 = format == ModelFormat::kV1;
    MessageWriter message;
    message.bytes(v1 ? 4 : 1, layer.name);
    if (!v1) message.bytes(2, layer.type);
    for (const TestBlob& blob : layer.blobs) {
      MessageWriter blob_message;
      if (v1) {
        std::vector<int> shape(4 - blob.shape.size(), 1);
        shape.insert(shape.end(), blob.shape.begin(), blob.shape.end());
        for (int i = 0; i < 4; ++i)
          blob_message.varint(i + 1, static_cast<std::uint64_t>(shape[static_cast<size_t>(i)]));
      } else {
        blob_message.bytes(7, MessageWriter().packed_varints(1, blob.shape).text());
      }
      blob_message.packed_floats(5, blob.values);
      message.bytes(v1 ? 6 : 7, blob_message.text());
    }
    return message.text();
  }

  int height_;
  int width_;
  int channels_;
  cv::Size current_;
  std::vector<cv::Size> pooled_;
  cv::RNG random_;
  bool whole_numbers_ = false;
  std::string top_ = "data";
  std::vector<TestLayer> layers_;
};

/// The layout of segnet_basic_camvid.prototxt.
inline TestNetwork segnet_basic(int height, int width, int features, int classes,
                                std::uint64_t seed) {
  TestNetwork network(height, width, seed);
  network.plain("LRN", "norm", false,
                "lrn_param {\n    local_size: 5\n    alpha: 0.0001\n    beta: 0.75\n  }\n");
  for (int level = 1; level <= 4; ++level) {
    const std::string number = std::to_string(level);
    network.convolution("conv" + number, features, 7).bn("conv" + number + "_bn");
    network.relu("relu" + number).pool("pool" + number);
  }
  for (int level = 4; level >= 1; --level) {
    const std::string number = std::to_string(level);
    network.upsample("upsample" + number, "pool" + number);
    network.convolution("conv_decode" + number, features, 7).bn("conv_decode" + number + "_bn");
  }
  return network.convolution("dense_softmax_inner_prod", classes, 1)
      .plain("ArgMax", "argmax", false, "argmax_param {\n    axis: 1\n  }\n");
}

/// The layout of segnet_pascal.prototxt: VGG-16 there and back. `divisor` makes it thinner.
inline TestNetwork segnet_vgg16(int height, int width, int divisor, int classes,
                                std::uint64_t seed) {
  const std::vector<std::vector<int>> encoder = {
      {64, 64}, {128, 128}, {256, 256, 256}, {512, 512, 512}, {512, 512, 512}};
  const std::vector<std::vector<int>> decoder = {
      {64}, {128, 64}, {256, 256, 128}, {512, 512, 256}, {512, 512, 512}};
  TestNetwork network(height, width, seed);
  const auto block = [&](const std::string& name, int channels) {
    network.convolution("conv" + name, channels / divisor, 3).bn("conv" + name + "_bn");
    network.relu("relu" + name);
  };
  for (std::size_t level = 1; level <= 5; ++level) {
    const std::string number = std::to_string(level);
    for (std::size_t i = 0; i < encoder[level - 1].size(); ++i)
      block(number + "_" + std::to_string(i + 1), encoder[level - 1][i]);
    network.plain("Dropout", "pool" + number + "_drop", true,
                  "dropout_param {\n    dropout_ratio: 0.5\n  }\n");
    network.pool("pool" + number);
  }
  for (std::size_t level = 5; level >= 1; --level) {
    const std::string number = std::to_string(level);
    network.plain("Dropout", "upsample" + number + "_drop", true,
                  "dropout_param {\n    dropout_ratio: 0.5\n  }\n");
    network.upsample("upsample" + number, "pool" + number);
    const std::size_t first = level == 1 ? 2 : decoder[level - 1].size();
    for (std::size_t i = 0; i < decoder[level - 1].size(); ++i)
      block(number + "_" + std::to_string(first - i) + "_D", decoder[level - 1][i]);
  }
  return network.convolution("conv1_1_D", classes, 3)
      .plain("Softmax", "prob", false, "softmax_param {engine: CAFFE}\n");
}

}  // namespace stillpoint::segmenter_segnet
