// A frame with its features, as tracking works on it.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "orb_slam/feature_grid.hpp"
#include "orb_slam/matcher.hpp"
#include "orb_slam/pose_solver.hpp"
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/contracts/static_weights.hpp"

namespace stillpoint::orb_slam {

struct ObservedFrame {
  FramePtr frame;
  FeaturesPtr features;
  FeatureGrid grid;
  std::vector<std::uint8_t> track_weights;  ///< per feature
  std::vector<std::uint8_t> map_weights;    ///< per feature
  std::vector<LandmarkId> landmarks;        ///< per feature, kNoId = none
  /// Per feature: in world, the point that the frame before measured, where no landmark is known.
  std::vector<std::optional<Eigen::Vector3d>> temporary;
  std::vector<bool> outlier;  ///< per feature: its point is no inlier to the pose
  Pose world_from_camera = Pose::Identity();
  KeyFrameId reference = kNoId;
  Pose reference_from_camera = Pose::Identity();
  /// Of the pose when it was solved last, as in PoseSolution.
  Matrix6d information = Matrix6d::Zero();
  Matrix6d temporary_information = Matrix6d::Zero();

  /// Below this weight a feature is not used at all.
  static constexpr std::uint8_t kMinWeight = 26;

  bool usable(std::uint32_t feature) const { return track_weights[feature] >= kMinWeight; }
  bool free(std::uint32_t feature) const { return landmarks[feature] == kNoId && usable(feature); }

  void set_weights(const StaticWeights& weights);
  /// Adds landmarks; the ids of the matches are theirs.
  void assign(std::span<const Match> matches);
  void clear_matches();
  /// Removes the matches that are outliers.
  void drop_outliers();
  /// Removes the temporary points.
  void drop_temporary();
  int usable_count() const;  ///< features that are used at all
  int matched() const;       ///< features with a landmark
  int inlier_count() const;  ///< those whose landmark is no outlier
};

/// Samples depth at the keypoints.
ObservedFrame observe(FramePtr frame, Features features);

/// A key frame's features to be matched anew, without images; what must not be mapped has no
/// weight.
ObservedFrame observation_of(const KeyFrame& keyframe);

/// Pose from the landmarks and temporary points assigned so far, starting from the frame's own;
/// marks the outliers and returns the number of inliers. Landmarks count in full from an age of
/// `probation` seconds on, younger ones less. Those of key frames before `first_keyframe` come
/// from another recording, with its own clock, and always count in full. `term` is an additional
/// cost on the pose.
int solve_pose(ObservedFrame& frame, const SparseMap& map, double probation = 0.0,
               KeyFrameId first_keyframe = 0, const PoseTerm& term = {});

}  // namespace stillpoint::orb_slam
