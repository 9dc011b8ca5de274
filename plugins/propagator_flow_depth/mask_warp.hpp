// Warps the mask of an object into the current view by the points tracked on it.
#pragma once

#include <opencv2/core/mat.hpp>
#include <span>

#include "propagator_flow_depth/point_follower.hpp"

namespace stillpoint::propagator_flow_depth {

/// Robust mean motion of an object since its reference view.
struct ObjectMotion {
  cv::Point2f shift;   ///< px
  float depth = 0.0f;  ///< metres, > 0 away from the camera
};

/// Medians over the tracks that are not lost; zero without tracks.
ObjectMotion median_motion(std::span<const Track> tracks);

/// The reference mask (CV_8UC1, 0 or 255, of `box`) as it lies in the part `region` of the current
/// view. Every pixel moves with the tracks around it, about `reach` px, so that limbs may move on
/// their own. Outside its box, the mask is extrapolated from its border: what enters the view there
/// is mostly more of the object.
cv::Mat warp_mask(const cv::Mat& reference, cv::Rect box, std::span<const Track> tracks,
                  cv::Rect region, float reach);

}  // namespace stillpoint::propagator_flow_depth
