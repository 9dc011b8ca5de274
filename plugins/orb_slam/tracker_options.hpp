// Options of the tracker; meanings and ranges are in visit().
#pragma once

#include "orb_slam/keyframe_policy.hpp"
#include "orb_slam/orb_extractor.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint::orb_slam {

struct TrackerOptions {
  OrbOptions orb;
  KeyFrameOptions keyframe;
  int min_start_points = 100;
  int min_inliers = 30;
  int min_bridge_points = 50;
  int local_keyframes = 80;
  double motion_window = 15.0;  // px
  double local_window = 3.0;    // px
  double probation = 0.0;       // seconds
  double max_feature_factor = 1.0;
  bool register_depth = true;

  void visit(OptionVisitor& visitor);
};

}  // namespace stillpoint::orb_slam
