// SegNet by plain loops, independent of OpenCV DNN: what the files of a TestNetwork must compute.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "segmenter_segnet/test_network.hpp"

namespace stillpoint::segmenter_segnet {

struct Tensor {
  Tensor() = default;
  Tensor(int c, int h, int w, double value = 0)
      : channels(c), height(h), width(w), values(static_cast<std::size_t>(c * h * w), value) {}

  double& at(int c, int y, int x) {
    return values[static_cast<std::size_t>((c * height + y) * width + x)];
  }
  double at(int c, int y, int x) const { return const_cast<Tensor*>(this)->at(c, y, x); }
  bool contains(int y, int x) const { return y >= 0 && y < height && x >= 0 && x < width; }

  int channels = 0;
  int height = 0;
  int width = 0;
  std::vector<double> values;
};

template <class Function>
Tensor transformed(const Tensor& input, const Function& value_of) {
  Tensor output(input.channels, input.height, input.width);
  for (int c = 0; c < input.channels; ++c)
    for (int y = 0; y < input.height; ++y)
      for (int x = 0; x < input.width; ++x) output.at(c, y, x) = value_of(c, y, x);
  return output;
}

inline Tensor convolve(const Tensor& input, const TestLayer& layer) {
  const std::vector<int>& shape = layer.blobs[0].shape;
  const int kernel = shape[2];
  Tensor output(shape[0], input.height + 2 * layer.pad - kernel + 1,
                input.width + 2 * layer.pad - kernel + 1);
  return transformed(output, [&](int o, int y, int x) {
    double sum = layer.blobs.size() > 1 ? layer.blobs[1].values[static_cast<std::size_t>(o)] : 0;
    for (int c = 0; c < input.channels; ++c)
      for (int j = 0; j < kernel; ++j)
        for (int i = 0; i < kernel; ++i)
          if (input.contains(y + j - layer.pad, x + i - layer.pad))
            sum += input.at(c, y + j - layer.pad, x + i - layer.pad) *
                   layer.blobs[0].values[static_cast<std::size_t>(
                       ((o * input.channels + c) * kernel + j) * kernel + i)];
    return sum;
  });
}

inline Tensor scale_and_shift(const Tensor& input, const TestLayer& layer) {
  return transformed(input, [&](int c, int y, int x) {
    const auto i = static_cast<std::size_t>(c);
    return input.at(c, y, x) * layer.blobs[0].values[i] + layer.blobs[1].values[i];
  });
}

inline Tensor batch_normalise(const Tensor& input, const TestLayer& layer, double epsilon) {
  return transformed(input, [&](int c, int y, int x) {
    const auto i = static_cast<std::size_t>(c);
    const double factor = layer.blobs[2].values[0];
    return (input.at(c, y, x) - layer.blobs[0].values[i] / factor) /
           std::sqrt(layer.blobs[1].values[i] / factor + epsilon);
  });
}

/// Across five channels, alpha 1e-4, beta 0.75.
inline Tensor normalise_response(const Tensor& input) {
  return transformed(input, [&](int c, int y, int x) {
    double sum = 0;
    for (int n = std::max(0, c - 2); n <= std::min(input.channels - 1, c + 2); ++n)
      sum += input.at(n, y, x) * input.at(n, y, x);
    return input.at(c, y, x) / std::pow(1 + 1e-4 / 5 * sum, 0.75);
  });
}

/// 2 x 2 with stride 2; a last odd row or column is pooled by itself. The first of equals wins.
inline void pool(const Tensor& input, Tensor& output, Tensor& mask) {
  output = mask = Tensor(input.channels, (input.height + 1) / 2, (input.width + 1) / 2);
  for (int c = 0; c < input.channels; ++c)
    for (int y = 0; y < output.height; ++y)
      for (int x = 0; x < output.width; ++x) {
        double best = -std::numeric_limits<double>::infinity();
        for (int j = 2 * y; j < std::min(2 * y + 2, input.height); ++j)
          for (int i = 2 * x; i < std::min(2 * x + 2, input.width); ++i)
            if (input.at(c, j, i) > best) {
              best = input.at(c, j, i);
              mask.at(c, y, x) = j * input.width + i;
            }
        output.at(c, y, x) = best;
      }
}

inline Tensor unpool(const Tensor& input, const Tensor& mask, cv::Size size) {
  Tensor output(input.channels, size.height, size.width);
  for (int c = 0; c < input.channels; ++c)
    for (int y = 0; y < input.height; ++y)
      for (int x = 0; x < input.width; ++x) {
        const int index = static_cast<int>(mask.at(c, y, x));
        output.at(c, index / size.width, index % size.width) = input.at(c, y, x);
      }
  return output;
}

inline Tensor tensor_of(const cv::Mat& image) {
  Tensor tensor(image.size[1], image.size[2], image.size[3]);
  std::copy_n(image.ptr<float>(), image.total(), tensor.values.begin());
  return tensor;
}

/// The network's scores: what goes into its softmax or argmax.
inline Tensor reference_scores(const TestNetwork& network, const cv::Mat& image) {
  std::map<std::string, Tensor> blobs;
  blobs["data"] = tensor_of(image);
  std::string last = "data";
  for (const TestLayer& layer : network.layers()) {
    if (layer.type == "Softmax" || layer.type == "ArgMax") break;
    const Tensor input = blobs.at(layer.bottoms[0]);
    last = layer.tops[0];
    Tensor& output = blobs[last];
    if (layer.type == "Convolution")
      output = convolve(input, layer);
    else if (layer.type == "BN" || layer.type == "Scale")
      output = scale_and_shift(input, layer);
    else if (layer.type == "BatchNorm")
      output = batch_normalise(input, layer, 1e-3);
    else if (layer.type == "LRN")
      output = normalise_response(input);
    else if (layer.type == "ReLU")
      output =
          transformed(input, [&](int c, int y, int x) { return std::max(0.0, input.at(c, y, x)); });
    else if (layer.type == "Pooling")
      pool(input, output, blobs[layer.tops[1]]);
    else if (layer.type == "Upsample")
      output = unpool(input, blobs.at(layer.bottoms[1]), layer.unpooled);
    else if (layer.type == "Dropout")
      output = input;
    else
      throw std::invalid_argument(layer.type);
  }
  return blobs.at(last);
}

}  // namespace stillpoint::segmenter_segnet
