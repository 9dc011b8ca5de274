// A point of the sparse map.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "stillpoint/contracts/features.hpp"
#include "stillpoint/contracts/ids.hpp"

namespace stillpoint {

/// A landmark seen as feature number `feature` of a key frame.
struct Observation {
  KeyFrameId keyframe = kNoId;
  std::uint32_t feature = 0;
};

struct Landmark {
  LandmarkId id = kNoId;
  Eigen::Vector3d position_in_world = Eigen::Vector3d::Zero();  ///< metres
  Eigen::Vector3d mean_view = Eigen::Vector3d::UnitZ();  ///< unit vector, camera to landmark, world
  /// Metres from the camera, between which its descriptor is found at some scale of the image.
  float min_distance = 0.0f;
  float max_distance = 0.0f;
  Descriptor descriptor{};                ///< the most typical of its observations
  std::vector<Observation> observations;  ///< ordered by key frame
  KeyFrameId reference = kNoId;           ///< key frame it moves with in corrections
  KeyFrameId created_by = kNoId;          ///< key frame whose insertion made it
  std::uint32_t visible = 1;              ///< frames in which it should have been seen
  std::uint32_t found = 1;                ///< frames in which it was
  float static_log_odds = 0.0f;           ///< > 0 static, < 0 moves
};

}  // namespace stillpoint
