// Points of objects, followed from view to view by pyramidal Lucas–Kanade.
#pragma once

#include <opencv2/core/mat.hpp>
#include <opencv2/core/types.hpp>
#include <span>
#include <vector>

#include "propagator_flow_depth/view.hpp"

namespace stillpoint::propagator_flow_depth {

/// A point of an object since its reference view; px of views.
struct Track {
  cv::Point2f reference;
  cv::Point2f current;
  float reference_depth = 0.0f;  ///< metres, 0 = no measurement
  float current_depth = 0.0f;    ///< metres, 0 = no measurement
  bool lost = false;
};

/// Gray levels and their derivatives as follow() needs them.
void build_flow_pyramid(const cv::Mat& gray, std::vector<cv::Mat>& pyramid);

/// Up to `most` corners inside a mask (CV_8UC1, of `box`), away from its outline, where the
/// gradient is that of the object against what is behind it.
std::vector<Track> choose_points(const View& view, const cv::Mat& mask, cv::Rect box, int most);

/// Moves points from one view to another. Lost are those whose forward-backward error exceeds
/// `max_error` px, that leave the image, or whose depth jumps, as that of a point does that drifts
/// from the object onto another surface.
void follow(const View& from, const View& to, std::span<Track*> tracks, float max_error);

}  // namespace stillpoint::propagator_flow_depth
