// A frame kept in the sparse map.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/contracts/features.hpp"
#include "stillpoint/contracts/ids.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint {

/// What tracking learnt about a landmark since the last key frame.
struct LandmarkEvidence {
  LandmarkId landmark = kNoId;
  std::uint32_t visible = 0;     ///< frames in which it should have been seen
  std::uint32_t found = 0;       ///< frames in which it was matched and fitted the pose
  float static_log_odds = 0.0f;  ///< added evidence that it is static (> 0) or moves (< 0)
};

/// Another key frame that sees the same landmarks.
struct Covisibility {
  KeyFrameId keyframe = kNoId;
  int shared = 0;  ///< landmarks seen by both
};

/// Made by the tracker, completed by the local mapper, constant once it is in a SparseMap.
struct KeyFrame {
  KeyFrameId id = kNoId;
  std::uint32_t frame = 0;  ///< index of its Frame
  double time = 0.0;        ///< seconds
  Pose world_from_camera = Pose::Identity();
  /// Covariance of the pose relative to the previous key frames, as in PoseUncertainty, when the
  /// landmarks alone did not constrain it; 0 otherwise, and in maps loaded from files.
  Matrix6d covariance = Matrix6d::Zero();
  std::shared_ptr<const Camera> camera;  ///< that of the frame; features are in its pixels
  FeaturesPtr features;                  ///< not null; without keypoints when the tracker has none
  std::vector<std::uint8_t> track_weights;  ///< per feature, as StaticWeights::track
  std::vector<std::uint8_t> map_weights;    ///< per feature, as StaticWeights::map
  std::vector<LandmarkId> landmarks;        ///< per feature, kNoId = none
  KeyFrameId parent = kNoId;                ///< spanning tree; kNoId for the first
  std::vector<Covisibility> covisible;      ///< most shared landmarks first
  std::vector<LandmarkEvidence> evidence;   ///< added to the landmarks at insertion, then empty
};

}  // namespace stillpoint
