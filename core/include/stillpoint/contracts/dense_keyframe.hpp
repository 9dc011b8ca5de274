// A key frame with all that is known of its image.
#pragma once

#include <memory>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/ids.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/contracts/static_weights.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint {

/// A key frame with its images.
struct DenseKeyFrame {
  KeyFrameId id = kNoId;
  FramePtr frame;
  SegmentationPtr segmentation;
  std::shared_ptr<const StaticWeights> weights;
  Pose world_from_camera = Pose::Identity();

  /// CV_8UC1, class id per pixel; empty when nothing is known.
  cv::Mat labels() const { return segmentation ? segmentation->labels : cv::Mat(); }
  /// CV_8UC1, as StaticWeights::map: 255 static … 0 do not map; empty: 255 everywhere.
  cv::Mat map_weights() const { return weights ? weights->map : cv::Mat(); }
};

}  // namespace stillpoint
