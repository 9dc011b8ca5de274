#include "orb_slam/depth_registration.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace stillpoint::orb_slam {
namespace {

constexpr int kMinPatches = 60;               // of 1,200, to constrain a pose
constexpr double kMinOverlapOfViews = 0.25;   // share of patches that key frames must cover
constexpr double kMinAgreement = 0.6;         // inlier share of those; likewise of landmarks
constexpr double kMaxOverlapOfNewView = 0.7;  // a smaller overlap requests a key frame

// Association gate: greatest point-to-plane distance in metres, smaller in every round, from what a
// predicted pose may be off to what registration leaves. Where the sensor's noise is larger,
// register_planes() widens it.
constexpr double kFirstReach = 0.12, kLastReach = 0.02, kReachFactor = 0.6;
double reach(int round) {
  return std::max(kFirstReach * std::pow(kReachFactor, round), kLastReach);
}

bool landmarks_agree(const ObservedFrame& frame) {
  const int inlier_count = frame.inlier_count();
  return inlier_count >= kMinLandmarksWithDepth && inlier_count >= kMinAgreement * frame.matched();
}

bool is_sound(const PlaneRegistration& registration) {
  return registration.patches >= kMinPatches && registration.overlap() >= kMinOverlapOfViews &&
         registration.agreement() >= kMinAgreement;
}

}  // namespace

void DepthRegistration::begin(FramePtr frame, const StaticWeights& weights) {
  frame_ = std::move(frame);
  weights_ = weights;
  view_.reset();
  registration_.reset();
}

Matrix6d DepthRegistration::information_of_view() {
  const PlacedView self{&view()};
  const PlaneRegistration registration =
      register_planes(view(), {&self, 1}, Pose::Identity(), reach(0));
  return registration.patches >= kMinPatches ? registration.cost.hessian
                                             : Matrix6d(Matrix6d::Zero());
}

bool DepthRegistration::refine(ObservedFrame& frame, const SparseMap& map,
                               const QuadraticCost& motion, const Solve& solve) {
  registration_.reset();
  const ReferenceViews::Neighbours around =
      references_.around(view(), frame.world_from_camera, map);
  if (around.views.empty()) return false;
  const ObservedFrame before = frame;
  if (frame.reference == kNoId) frame.reference = around.nearest;
  if (frame.matched() < kMinLandmarksWithDepth) frame.clear_matches();
  PlaneRegistration registration;
  const PoseTerm surfaces_and_motion = [&](const Pose& camera_from_world, int round) {
    registration = register_planes(view(), around.views, camera_from_world, reach(round));
    return registration.cost + motion.moved_to(camera_from_world);
  };
  solve(surfaces_and_motion);
  // Inliers by chance would move the camera along directions that no surface constrains, and add
  // false information there.
  if (frame.matched() > 0 && !landmarks_agree(frame)) {
    frame.clear_matches();
    frame.world_from_camera = before.world_from_camera;
    solve(surfaces_and_motion);
  }
  frame.information -= motion.hessian;
  if (!is_sound(registration)) {
    frame = before;
    return false;
  }
  registration_ = registration;
  return true;
}

bool DepthRegistration::shows_new_surfaces() const {
  return registration_ && registration_->overlap() < kMaxOverlapOfNewView;
}

const DepthView& DepthRegistration::view() {
  if (!view_) view_.emplace(*frame_, weights_);
  return *view_;
}

}  // namespace stillpoint::orb_slam
