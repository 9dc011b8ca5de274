// The weights of a network: a .caffemodel.
#pragma once

#include <filesystem>
#include <map>
#include <opencv2/core/mat.hpp>
#include <string>
#include <vector>

namespace stillpoint::segmenter_segnet {

/// The blobs of each layer that has any: CV_32F, one dimension per dimension of the blob (1 x n for
/// a blob of one dimension).
using CaffeWeights = std::map<std::string, std::vector<cv::Mat>>;

/// Reads current and V1 layers. Throws Error(kData) for a file that is
/// missing, truncated, or something else.
CaffeWeights read_caffe_weights(const std::filesystem::path& file);

/// "64 x 3 x 7 x 7".
std::string shape_text(const std::vector<int>& shape);
std::vector<int> shape_of(const cv::Mat& blob);

}  // namespace stillpoint::segmenter_segnet
