#include "orb_slam/local_mapper.hpp"
#include "orb_slam/loop_closer.hpp"
#include "orb_slam/tracker.hpp"
#include "stillpoint/sdk.hpp"

STILLPOINT_PLUGIN(
    orb_slam, "0.1.0",
    stillpoint::provide<stillpoint::Tracker, stillpoint::orb_slam::OrbTracker>(
        "orb", "ORB features tracked in the sparse map (ORB-SLAM2)"),
    stillpoint::provide<stillpoint::LocalMapper, stillpoint::orb_slam::OrbLocalMapper>(
        "orb", "landmarks, culling and local bundle adjustment (ORB-SLAM2)"),
    stillpoint::provide<stillpoint::LoopCloser, stillpoint::orb_slam::OrbLoopCloser>(
        "orb", "place index, pose graph and full bundle adjustment (ORB-SLAM2)"));
