#include <stillpoint/sdk.hpp>

#include "moving_checks/lk_checker.hpp"
#include "moving_checks/rgbd_checker.hpp"

using stillpoint::MovingChecker;
using stillpoint::provide;

STILLPOINT_PLUGIN(moving_checks, "0.1.0",
                  provide<MovingChecker, stillpoint::moving_checks::LkEpipolar>(
                      "lk_epipolar", "optical flow and epipolar distance (DS-SLAM, Algorithm 1)"),
                  provide<MovingChecker, stillpoint::moving_checks::LkUsac>(
                      "lk_usac", "lk_epipolar with the fundamental matrix of USAC"),
                  provide<MovingChecker, stillpoint::moving_checks::LkMagsac>(
                      "lk_magsac", "lk_epipolar with the fundamental matrix of MAGSAC"),
                  provide<MovingChecker, stillpoint::moving_checks::LkHomography>(
                      "lk_homography", "optical flow and one homography for all static points"),
                  provide<MovingChecker, stillpoint::moving_checks::RgbdChecker>(
                      "rgbd_reprojection",
                      "optical flow and depth against the rigid motion of the camera"));
