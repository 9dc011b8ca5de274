// One object as it is followed from frame to frame.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "propagator_flow_depth/depth_layer.hpp"
#include "propagator_flow_depth/point_follower.hpp"

namespace stillpoint::propagator_flow_depth {

struct FollowedObject {
  int id = 0;
  int label = 0;
  float score = 1.0f;

  // From the results of the network.
  std::uint32_t detected_frame = 0;  ///< index of the newest frame in which it was found
  double detected_time = 0.0;        ///< seconds, of that frame
  int detections = 0;                ///< results that had it
  int misses = 0;  ///< results in a row that did not have it, while it was in view

  // Its reference: the view from which it is carried, mostly the one in which it was found.
  cv::Mat reference_mask;  ///< CV_8UC1, 0 or 255, of `reference_box`
  cv::Rect reference_box;  ///< with a pixel of background around the mask, unless the image ends
  DepthLayer reference_layer;
  std::vector<Track> tracks;
  std::uint32_t tracked_frame = 0;  ///< index of the frame that the tracks have come to
  int points = 0;                   ///< most tracks to begin with
  std::size_t first_tracks = 0;     ///< that the reference began with

  // In the current view.
  cv::Mat mask;  ///< CV_8UC1, 0 or 255, of `box`
  cv::Rect box;
  DepthLayer layer;
  double support = 0.0;  ///< share of the mask's measurements that lie in the layer
};

}  // namespace stillpoint::propagator_flow_depth
