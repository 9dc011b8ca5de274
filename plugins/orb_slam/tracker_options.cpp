#include "orb_slam/tracker_options.hpp"

namespace stillpoint::orb_slam {

void TrackerOptions::visit(OptionVisitor& v) {
  orb.visit(v);
  v("min_start_points", min_start_points,
    {.min = 20, .help = "features with depth that the first key frame needs"});
  v("min_inliers", min_inliers,
    {.min = 6, .help = "with fewer fitting landmarks tracking is lost"});
  v("min_bridge_points", min_bridge_points,
    {.min = 6,
     .help = "points that must fit where the map is not enough and the last frame's depth helps"});
  v("local_keyframes", local_keyframes,
    {.min = 1, .help = "key frames whose landmarks are searched for in a frame"});
  v("motion_window", motion_window,
    {.min = 1,
     .unit = "px",
     .help = "search radius around the place predicted from the last frame"});
  v("local_window", local_window,
    {.min = 0.5, .unit = "px", .help = "search radius around the place predicted from the map"});
  v("probation", probation,
    {.min = 0,
     .max = 60,
     .unit = "s",
     .help = "until a new landmark counts in full for the pose, where something about may move; 0: "
             "at once"});
  v("max_feature_factor", max_feature_factor,
    {.min = 1,
     .max = 4,
     .help = "times `features`, to make up for a part of the image that cannot be mapped"});
  v("hold_by_depth", hold_by_depth,
    {.help = "where landmarks do not hold the pose, surfaces in depth do"});
  keyframe.visit(v);
}

}  // namespace stillpoint::orb_slam
