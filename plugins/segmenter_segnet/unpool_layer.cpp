#include "segmenter_segnet/unpool_layer.hpp"

#include <algorithm>
#include <mutex>
#include <opencv2/dnn/layer.hpp>

#include "stillpoint/error.hpp"

namespace stillpoint::segmenter_segnet {
namespace {

cv::Ptr<cv::dnn::Layer> create(cv::dnn::LayerParams& parameters) {
  return cv::makePtr<UnpoolLayer>(parameters);
}

/// False for an index outside of the channel: pooling gives -1 where all values are NaN.
bool scatter(const float* values, const float* mask, int count, float* channel, int size) {
  std::fill_n(channel, size, 0.0f);
  for (int i = 0; i < count; ++i) {
    const int index = static_cast<int>(mask[i]);
    if (index < 0 || index >= size) return false;
    channel[index] = values[i];
  }
  return true;
}

}  // namespace

UnpoolLayer::UnpoolLayer(const cv::dnn::LayerParams& parameters)
    : cv::dnn::Layer(parameters),
      height_(parameters.get<int>("output_height")),
      width_(parameters.get<int>("output_width")) {}

void UnpoolLayer::register_type() {
  static std::once_flag once;
  std::call_once(once, [] { cv::dnn::LayerFactory::registerLayer(kType, create); });
}

bool UnpoolLayer::getMemoryShapes(const std::vector<cv::dnn::MatShape>& inputs, int,
                                  std::vector<cv::dnn::MatShape>& outputs,
                                  std::vector<cv::dnn::MatShape>&) const {
  outputs = {{inputs[0][0], inputs[0][1], height_, width_}};
  return false;  // not in place
}

void UnpoolLayer::forward(cv::InputArrayOfArrays inputs_, cv::OutputArrayOfArrays outputs_,
                          cv::OutputArrayOfArrays) {
  std::vector<cv::Mat> inputs, outputs;
  inputs_.getMatVector(inputs);
  outputs_.getMatVector(outputs);
  const int channels = inputs[0].size[1];
  const int count = inputs[0].size[2] * inputs[0].size[3];
  for (int c = 0; c < channels; ++c)
    if (!scatter(inputs[0].ptr<float>(0, c), inputs[1].ptr<float>(0, c), count,
                 outputs[0].ptr<float>(0, c), height_ * width_))
      throw Error(Fault::kStage, "its values are not finite", "layer '" + name + "'");
}

}  // namespace stillpoint::segmenter_segnet
