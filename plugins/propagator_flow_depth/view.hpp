// A frame at half resolution, which is accurate enough for tracking and four times as fast.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "stillpoint/contracts/frame.hpp"

namespace stillpoint::propagator_flow_depth {

/// px of a frame per pixel of its view. All positions in this plugin are pixels of views.
inline constexpr int kViewScale = 2;

struct View {
  std::uint32_t frame = 0;       ///< index
  double time = 0.0;             ///< seconds
  std::vector<cv::Mat> pyramid;  ///< of gray values, with derivatives, for optical flow
  cv::Mat depth;                 ///< CV_32FC1, metres, 0 = no measurement
  cv::Mat instances;     ///< CV_8UC1, 1 + index into `ids`, 0 = none; once objects are known
  std::vector<int> ids;  ///< of the objects followed in this frame

  cv::Size size() const { return depth.size(); }
};

/// `recycled` is a view that is no longer needed: its images are written over, because fetching so
/// much memory from the system for each frame costs more than filling it.
View make_view(const Frame& frame, View recycled = {});

/// Depth at a position, 0 = no measurement.
float depth_at(const View& view, cv::Point2f position);

}  // namespace stillpoint::propagator_flow_depth
