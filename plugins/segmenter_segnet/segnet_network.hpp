// A SegNet from its Caffe files, run by OpenCV DNN.
#pragma once

#include <filesystem>
#include <opencv2/dnn.hpp>

namespace stillpoint::segmenter_segnet {

class SegnetNetwork {
 public:
  /// Throws Error(kData) when the files are damaged or do not belong together, naming the layer.
  SegnetNetwork(const std::filesystem::path& prototxt, const std::filesystem::path& model);

  cv::Size input_size() const { return {input_shape_[3], input_shape_[2]}; }
  cv::Size output_size() const { return {output_shape_[3], output_shape_[2]}; }
  int channels() const { return output_shape_[1]; }  ///< of the scores: classes

  /// Scores (1 x classes x height x width, before any softmax) of an image (1 x 3 x height x width,
  /// CV_32F). They are overwritten by the next call.
  cv::Mat scores(const cv::Mat& image);

 private:
  cv::dnn::Net net_;
  std::vector<int> input_shape_;
  std::vector<int> output_shape_;
  std::string output_;  // layer
};

}  // namespace stillpoint::segmenter_segnet
