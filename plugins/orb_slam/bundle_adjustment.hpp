// Local and full bundle adjustment.
#pragma once

#include <optional>
#include <stop_token>
#include <vector>

#include "stillpoint/contracts/map_correction.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

struct BundleOptions {
  int max_keyframes = 10;  ///< adjusted locally; others that see the same landmarks stay fixed
  int max_iterations = 5;
};

/// Adjusts a key frame, its most covisible neighbours and the landmarks they see, over reprojection
/// and inverse depth, weighted by pyramid level, depth noise and static weight, with a Huber
/// kernel; then removes the observations that do not fit. The first key frame always stays. Ends
/// after the current iteration when `end_early` is requested. Returns the landmarks that were
/// adjusted.
std::vector<LandmarkId> adjust_locally(MapEdit& edit, KeyFrameId centre,
                                       const BundleOptions& options,
                                       const std::stop_token& end_early);

/// The same over all key frames and landmarks. Observations stay; nothing when there are none.
std::optional<MapCorrection> adjust_all(const SparseMap& map, int max_iterations,
                                        const std::stop_token& end_early);

}  // namespace stillpoint::orb_slam
