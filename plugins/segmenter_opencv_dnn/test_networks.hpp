// Small networks whose results are known, written as files.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

#include "segmenter_opencv_dnn/opencv_dnn_segmenter.hpp"
#include "support/recording_writer.hpp"

namespace stillpoint::segmenter_opencv_dnn {

inline std::string read_file(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::string bytes_of(const std::vector<float>& values) {
  return {reinterpret_cast<const char*>(values.data()), values.size() * sizeof(float)};
}

inline std::filesystem::path shipped_model() {
  return STILLPOINT_SOURCE_DIR
      "/plugins/segmenter_opencv_dnn/models/selfie_segmentation_landscape.onnx";
}

inline NetworkOptions caffe_network(const testing::TemporaryFolder& folder,
                                    const std::string& layers, cv::Size input) {
  NetworkOptions options;
  options.config = folder.write(
      "net.prototxt", "name: \"test\" input: \"data\" input_dim: 1 input_dim: 3 input_dim: " +
                          std::to_string(input.height) +
                          " input_dim: " + std::to_string(input.width) + "\n" + layers);
  options.model = folder.write("net.caffemodel", "");  // none of the layers has weights
  options.width = input.width;
  options.height = input.height;
  options.scale = {1.0};
  return options;
}

/// Puts out every `stride`-th pixel of the input: red, green and blue are scores of three classes.
inline std::string subsampling(int stride) {
  return "layer { name: \"cells\" type: \"Pooling\" bottom: \"data\" top: \"cells\" "
         "pooling_param { pool: MAX kernel_size: 1 stride: " +
         std::to_string(stride) + " } }\n";
}

/// Fields of Protocol Buffers, for numbers and lengths below 128.
inline std::string proto_number(int field, int value) {
  return {static_cast<char>(field << 3), static_cast<char>(value)};
}
inline std::string proto_bytes(int field, const std::string& bytes) {
  EXPECT_LT(bytes.size(), 128U);
  return std::string{static_cast<char>(field << 3 | 2), static_cast<char>(bytes.size())} + bytes;
}

/// As subsampling(), frozen by TensorFlow: a GraphDef of two nodes, images with channels last.
inline NetworkOptions tensorflow_network(const testing::TemporaryFolder& folder, int stride,
                                         cv::Size input) {
  const auto attribute = [](const std::string& key, const std::string& value) {
    return proto_bytes(5, proto_bytes(1, key) + proto_bytes(2, value));
  };
  const auto list = [](int y, int x) {
    const std::string steps{1, static_cast<char>(y), static_cast<char>(x), 1};
    return proto_bytes(1, proto_bytes(3, steps));
  };
  const auto node = [](const std::string& name, const std::string& operation) {
    return proto_bytes(1, name) + proto_bytes(2, operation);
  };
  constexpr int kFloat = 1;
  const std::string image =
      node("data", "Placeholder") + attribute("dtype", proto_number(6, kFloat));
  const std::string cells =
      node("cells", "MaxPool") + proto_bytes(3, "data") + attribute("ksize", list(1, 1)) +
      attribute("strides", list(stride, stride)) + attribute("padding", proto_bytes(2, "VALID"));
  NetworkOptions options;
  options.model = folder.write("net.pb", proto_bytes(1, image) + proto_bytes(1, cells));
  options.width = input.width;
  options.height = input.height;
  options.scale = {1.0};
  return options;
}

/// Puts out the red channel as `red`, the others as `rest`.
inline std::string red_channel() {
  return "layer { name: \"slice\" type: \"Slice\" bottom: \"data\" top: \"red\" top: \"rest\" "
         "slice_param { axis: 1 slice_point: 1 } }\n"
         "layer { name: \"out\" type: \"Power\" bottom: \"red\" top: \"out\" }\n"
         "layer { name: \"other\" type: \"Power\" bottom: \"rest\" top: \"other\" }\n";
}

/// Finds always the same: in the middle, half as wide and high as the image, the first of two
/// classes with a score of 0.95 * 0.9.
inline NetworkOptions darknet_network(const testing::TemporaryFolder& folder) {
  NetworkOptions options;
  options.config = folder.write("net.cfg",
                                "[net]\nwidth=32\nheight=32\nchannels=3\n\n"
                                "[convolutional]\nfilters=7\nsize=1\nstride=32\npad=0\n"
                                "activation=linear\n\n"
                                "[yolo]\nmask=0\nanchors=16,8\nclasses=2\nnum=1\n");
  const auto logit = [](float p) { return std::log(p / (1 - p)); };
  std::vector<float> weights = {0,           0,           0, std::log(2.0f), logit(0.95f),
                                logit(0.9f), logit(0.02f)};  // biases: x, y, w, h, object, classes
  weights.resize(7 + 7 * 3);
  const std::string header("\0\0\0\0\2\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0", 20);  // version 0.2
  options.model = folder.write("net.weights", header + bytes_of(weights));
  options.width = options.height = 32;
  return options;
}

/// Frame of one colour per block of `block` pixels; `rgb` holds one pixel per block.
inline Frame blocks(const cv::Mat& rgb, int block) {
  Frame frame;
  frame.bgr = cv::Mat(rgb.rows * block, rgb.cols * block, CV_8UC3);
  for (int y = 0; y < frame.bgr.rows; ++y)
    for (int x = 0; x < frame.bgr.cols; ++x) {
      const auto colour = rgb.at<cv::Vec3b>(y / block, x / block);
      frame.bgr.at<cv::Vec3b>(y, x) = {colour[2], colour[1], colour[0]};
    }
  return frame;
}

}  // namespace stillpoint::segmenter_opencv_dnn
