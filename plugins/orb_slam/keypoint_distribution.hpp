// Chooses corners that cover the image evenly.
#pragma once

#include <opencv2/core/types.hpp>
#include <vector>

#include "orb_slam/fast_corners.hpp"

namespace stillpoint::orb_slam {

/// Removes corners with score <= `threshold` from every square cell of `cell` px that holds a
/// stronger one: weak corners only where there is nothing better.
void drop_weak_beside_strong(std::vector<Corner>& corners, cv::Size image, int cell, int threshold);

/// Keeps at most `count` corners: the strongest of their neighbourhood, with the neighbourhood as
/// large as the count allows. Suppression via square covering (Bailo et al., Pattern Recognition
/// Letters 106, 2018). Sorted by score, strongest first; equal scores keep their order.
void keep_evenly_spread(std::vector<Corner>& corners, cv::Size image, int count);

}  // namespace stillpoint::orb_slam
