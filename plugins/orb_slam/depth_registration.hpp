// Depth registration, for frames whose landmarks do not constrain the pose.
#pragma once

#include <functional>
#include <optional>

#include "orb_slam/observed_frame.hpp"
#include "orb_slam/reference_views.hpp"
#include "stillpoint/contracts/static_weights.hpp"

namespace stillpoint::orb_slam {

/// Registers one frame after the other to the depth of earlier ones.
class DepthRegistration {
 public:
  /// Solves the frame's pose from its landmarks and an additional cost term.
  using Solve = std::function<void(const PoseTerm& term)>;

  /// A new frame, nothing of which is computed until it is needed.
  void begin(FramePtr frame, const StaticWeights& weights);

  /// Information matrix of a pose from the surfaces in view alone, as in PoseSolution; zero where
  /// they are too few.
  Matrix6d information_of_view();

  /// Solves the pose with the surfaces and the motion prior `motion`, starting from the frame's own
  /// pose. Landmark matches that are too few or inconsistent with the surfaces are removed. Returns
  /// false, and leaves the frame unchanged, when its depth is inconsistent with the key frames'.
  bool refine(ObservedFrame& frame, const SparseMap& map, const QuadraticCost& motion,
              const Solve& solve);

  /// Forgets how the frame was refined: its pose is another one.
  void discard() { registration_.reset(); }

  bool refined() const { return registration_.has_value(); }
  /// The depth has refined the pose, but key frames cover too few of the surfaces in view.
  bool shows_new_surfaces() const;

  /// Later frames may be registered to this one, which is seen from beside a key frame, or is one.
  void add_reference(KeyFrameId keyframe, const Pose& keyframe_from_camera = Pose::Identity()) {
    references_.add(keyframe, keyframe_from_camera, view());
  }
  void forget_references() { references_ = {}; }

 private:
  const DepthView& view();

  FramePtr frame_;
  StaticWeights weights_;
  std::optional<DepthView> view_;
  std::optional<PlaneRegistration> registration_;  // set when it constrains the frame's pose
  ReferenceViews references_;
};

/// Least number of landmarks to use together with surfaces; fewer may all be outliers.
inline constexpr int kMinLandmarksWithDepth = 12;

}  // namespace stillpoint::orb_slam
