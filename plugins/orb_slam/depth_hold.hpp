// Where landmarks do not hold the pose, surfaces in depth do.
#pragma once

#include <functional>
#include <optional>

#include "orb_slam/depth_anchor.hpp"
#include "orb_slam/observed_frame.hpp"
#include "stillpoint/contracts/static_weights.hpp"

namespace stillpoint::orb_slam {

/// Of one frame after the other, against the depth of the newest key frames.
class DepthHold {
 public:
  /// Solves the frame's pose from its landmarks and a further term.
  using Solve = std::function<void(const PoseTerm& term)>;

  /// A new frame, nothing of which is computed until it is needed.
  void begin(FramePtr frame, const StaticWeights& weights);

  /// Of a pose that the surfaces in view alone would hold, as in PoseSolution; zero where they are
  /// too few.
  Matrix6d information_of_view();

  /// Solves the pose with the surfaces and with `motion`, from the frame's own pose on. Landmarks
  /// that are few or do not agree with the surfaces are taken away. False, and the frame as it was,
  /// when depth does not agree with that of the key frames.
  bool hold(ObservedFrame& frame, const SparseMap& map, const QuadraticCost& motion,
            const Solve& solve);

  bool held() const { return registration_.has_value(); }
  /// Held, by surfaces of which key frames know too little.
  bool shows_new_surfaces() const;

  /// The frame has become a key frame.
  void add_keyframe(KeyFrameId keyframe) { anchor_.add(keyframe, view()); }

 private:
  const DepthView& view();

  FramePtr frame_;
  StaticWeights weights_;
  std::optional<DepthView> view_;
  std::optional<PlaneRegistration> registration_;  // when the frame's pose needed it
  DepthAnchor anchor_;
};

/// Of landmarks beside surfaces; fewer may all be wrong.
inline constexpr int kMinHeldLandmarks = 12;

}  // namespace stillpoint::orb_slam
