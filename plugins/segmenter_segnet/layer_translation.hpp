// From Caffe's layers to OpenCV's, one by one.
#pragma once

#include <opencv2/dnn.hpp>
#include <string>
#include <vector>

#include "segmenter_segnet/network_definition.hpp"

namespace stillpoint::segmenter_segnet {

/// A blob that a layer reads.
struct BlobShape {
  std::vector<int> shape;   ///< 1, channels, height, width
  std::vector<int> pooled;  ///< of a pooling layer's mask: shape of what was pooled; else empty
};

/// The OpenCV layer for a Caffe layer. Layers that are the identity in inference have no type.
struct TranslatedLayer {
  std::string type;
  cv::dnn::LayerParams parameters;

  bool is_identity() const { return type.empty(); }
};

/// `blobs` are the layer's weights, `inputs` what its bottoms are. Throws Error(kData) that names
/// the layer when its type is unknown, or when weights are missing, of another shape or not finite.
TranslatedLayer translate(const LayerDefinition& layer, const std::vector<cv::Mat>& blobs,
                          const std::vector<BlobShape>& inputs);

/// Whether the layer is a softmax or argmax, whose input are the network's scores.
bool reads_scores(const LayerDefinition& layer);

}  // namespace stillpoint::segmenter_segnet
