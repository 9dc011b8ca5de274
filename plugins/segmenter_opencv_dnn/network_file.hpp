// From files to a network.
#pragma once

#include <opencv2/core/base.hpp>
#include <opencv2/dnn/dnn.hpp>
#include <string>

namespace stillpoint::segmenter_opencv_dnn {

/// Reads ONNX, Caffe, TensorFlow or Darknet files, told apart by the model's suffix; `config` is
/// empty where the kind needs none. Throws Error(kUsage) or Error(kData).
cv::dnn::Net read_network(const std::string& model, const std::string& config);

/// OpenCV's message in one line, with the layer that is not supported.
std::string reason(const cv::Exception& exception);

}  // namespace stillpoint::segmenter_opencv_dnn
