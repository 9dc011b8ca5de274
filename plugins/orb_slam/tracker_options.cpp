#include "orb_slam/tracker_options.hpp"

namespace stillpoint::orb_slam {

void TrackerOptions::visit(OptionVisitor& v) {
  orb.visit(v);
  v("min_start_points", min_start_points,
    {.min = 20, .help = "features with depth that the first key frame needs"});
  v("min_inliers", min_inliers,
    {.min = 6,
     .help = "landmarks needed for a pose; with fewer, points of the last frame are added, or "
             "depth registration"});
  v("min_bridge_points", min_bridge_points,
    {.min = 6,
     .help = "inliers needed for a pose where points of the last frame were added to too few "
             "landmarks"});
  v("local_keyframes", local_keyframes,
    {.min = 1,
     .help = "size of the local map: key frames whose landmarks are searched for in a frame"});
  v("motion_window", motion_window,
    {.min = 1,
     .unit = "px",
     .help = "search radius around the pixel predicted from the last frame"});
  v("local_window", local_window,
    {.min = 0.5, .unit = "px", .help = "search radius around the pixel predicted from the map"});
  v("probation", probation,
    {.min = 0,
     .max = 60,
     .unit = "s",
     .help = "age from which a new landmark has full weight in the pose, while dynamic objects are "
             "around; 0: at once"});
  v("max_feature_factor", max_feature_factor,
    {.min = 1,
     .max = 4,
     .help = "where dynamic objects cover a part of the image, up to this many times `features` "
             "are extracted from the rest; 1: never more"});
  v("register_depth", register_depth,
    {.help = "align the depth image to earlier ones, as ICP does, where landmarks do not constrain "
             "the pose"});
  keyframe.visit(v);
}

}  // namespace stillpoint::orb_slam
