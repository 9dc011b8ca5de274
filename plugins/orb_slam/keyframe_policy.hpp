// Which frames become key frames (ORB-SLAM2, III-E).
#pragma once

#include "orb_slam/observed_frame.hpp"
#include "stillpoint/contracts/tracker.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint::orb_slam {

struct KeyFrameOptions {
  double max_seconds_between = 1;
  double min_tracked_ratio = 0.8;
  double moved = 0.02;  // as TrackingQuality::motion
  double moved_tracked_ratio = 0.9;
  int min_inliers = 15;
  double close_depth = 3.0;  // metres
  int min_close = 100;
  int max_close_untracked = 70;

  void visit(OptionVisitor& visitor);
};

/// What the key frame decision depends on.
struct TrackingQuality {
  int inliers = 0;                ///< landmarks of the map that are inliers to the pose
  int established = 0;            ///< landmarks that the reference key frame shares with others
  int most_inliers = 0;           ///< of a frame with this reference key frame, see MostInliers
  int close_tracked = 0;          ///< features with near depth and an inlier landmark
  int close_untracked = 0;        ///< features with near depth and none, which could become one
  double seconds_since_last = 0;  ///< since the last key frame of this recording
  double motion = 0;  ///< since the reference: translation in median depths + rotation in radians
  bool depth_registered = false;  ///< the pose does not depend on landmarks
};

/// The most inliers of a frame since this key frame is the reference.
class MostInliers {
 public:
  int update(KeyFrameId reference, int inliers);

 private:
  KeyFrameId reference_ = kNoId;
  int most_ = 0;
};

/// `most_inliers` and `depth_registered` are the caller's.
TrackingQuality tracking_quality(const ObservedFrame& frame, const SparseMap& map, int inliers,
                                 double seconds_since_last, const KeyFrameOptions& options);

bool needs_keyframe(const TrackingQuality& quality, TrackHints hints,
                    const KeyFrameOptions& options);

}  // namespace stillpoint::orb_slam
