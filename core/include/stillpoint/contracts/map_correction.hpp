// What a loop closure changes, computed on an older version of the map.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// A key frame and where it is now.
struct MovedKeyFrame {
  KeyFrameId keyframe = kNoId;
  Pose world_from_camera = Pose::Identity();
};

struct MapCorrection {
  KeyFrameId keyframe_id_end = 0;  ///< of the map it was computed on
  std::vector<MovedKeyFrame> moved;
  /// Landmark positions in world, where optimised; others move with their reference key frame.
  std::vector<std::pair<LandmarkId, Eigen::Vector3d>> landmarks;
  std::vector<std::pair<LandmarkId, LandmarkId>> fused;  ///< kept, gone
};

/// Applies a correction to a map that may have grown since: newer key frames move with their
/// parent, landmarks with their reference key frame. Elements that are gone are passed over.
STILLPOINT_EXPORT SparseMap apply(const MapCorrection& correction, SparseMap map);

}  // namespace stillpoint
