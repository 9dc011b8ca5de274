// SegNet's Upsample, which OpenCV DNN lacks: each value goes back to where max pooling took it
// from, the rest is zero (Badrinarayanan et al., PAMI 2017, section 3).
#pragma once

#include <opencv2/dnn.hpp>

namespace stillpoint::segmenter_segnet {

/// Inputs: values and the mask of the pooling layer, whose numbers are indices into a channel of
/// the output. Parameters: output_height, output_width.
class UnpoolLayer final : public cv::dnn::Layer {
 public:
  static constexpr const char* kType = "StillpointSegnetUnpool";

  explicit UnpoolLayer(const cv::dnn::LayerParams& parameters);

  /// Registers the type with OpenCV DNN, once. The name is no Caffe type, so that other networks in
  /// this process do not use it by accident.
  static void register_type();

  bool getMemoryShapes(const std::vector<cv::dnn::MatShape>& inputs, int required_outputs,
                       std::vector<cv::dnn::MatShape>& outputs,
                       std::vector<cv::dnn::MatShape>& internals) const override;
  void forward(cv::InputArrayOfArrays inputs, cv::OutputArrayOfArrays outputs,
               cv::OutputArrayOfArrays internals) override;

 private:
  int height_;
  int width_;
};

}  // namespace stillpoint::segmenter_segnet
