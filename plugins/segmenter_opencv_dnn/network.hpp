// A network that OpenCV reads, and its input.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/dnn/dnn.hpp>
#include <string>
#include <vector>

#include "stillpoint/options.hpp"

namespace stillpoint::segmenter_opencv_dnn {

enum class ChannelOrder { kRgb, kBgr };

struct NetworkOptions {
  std::string model = "selfie_segmentation_landscape.onnx";
  std::string config;
  int width = 256;                          ///< px, of the input
  int height = 144;                         ///< px
  std::vector<double> scale = {1.0 / 255};  ///< one, or one per channel
  std::vector<double> mean = {0.0};         ///< one, or one per channel, in the network's order
  ChannelOrder channels = ChannelOrder::kRgb;
  std::string output;   ///< empty: the only one
  int brighten_to = 0;  ///< level, 0 to 255, of the brightest percent of a dark image; 0: as it is

  void visit(OptionVisitor& visitor);
};

/// The constructor checks files, layers and input size by a forward pass on a black image. Throws
/// Error(kUsage) for wrong options and Error(kData) for an unusable file.
class Network {
 public:
  /// `all_outputs`: without an output's name, take all of them instead of the only one.
  Network(const NetworkOptions& options, bool all_outputs);

  /// The outputs for an image of any size, stretched to the input. They are valid until the next
  /// call. Throws Error(kStage) when OpenCV does, and for outputs that are not finite.
  std::vector<cv::Mat> run(const cv::Mat& bgr);
  /// Whether the last image was dark, and brightened.
  bool brightened() const { return gain_ > 1; }

  /// Of that forward pass.
  const std::vector<cv::Mat>& trial_outputs() const { return trial_outputs_; }
  const std::string& file() const { return file_; }
  cv::Size input_size() const { return {options_.width, options_.height}; }

 private:
  cv::Mat input(const cv::Mat& bgr);
  std::vector<cv::Mat> forward(const cv::Mat& bgr);

  NetworkOptions options_;
  std::string file_;
  cv::dnn::Net net_;
  std::vector<std::string> outputs_;
  std::vector<cv::Mat> trial_outputs_;
  double gain_ = 1;  // of the last image
};

}  // namespace stillpoint::segmenter_opencv_dnn
