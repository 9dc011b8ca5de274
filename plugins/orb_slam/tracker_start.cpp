// How the map of a tracker begins, and when it is given up for another one.
#include <algorithm>

#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/orb_keyframe.hpp"
#include "orb_slam/pose_uncertainty.hpp"
#include "orb_slam/tracker.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr double kYoungMap = 10.0;        // seconds; a map tracked for less may be given up
constexpr double kLeastSearch = 1.0;      // seconds, before it is
constexpr double kLongestInterval = 0.2;  // seconds between frames; more is a gap in the recording

}  // namespace

// With a map of an earlier run, or an empty one.
void OrbTracker::begin_with(const SparseMap& map) {
  require_orb(map);
  first_keyframe_ = map.keyframe_id_end();
}

bool OrbTracker::has_start_points() const {
  int points = 0;
  for (std::uint32_t i = 0; i < current_.features->size(); ++i)
    points += current_.features->depth[i] > 0 && current_.track_weights[i] >= kMinMapWeight &&
              current_.map_weights[i] >= kMinMapWeight;
  return points >= options_.min_start_points;
}

bool OrbTracker::can_start() { return has_start_points() || surfaces_suffice(); }

// The first key frame defines the world.
void OrbTracker::start() {
  current_.world_from_camera = Pose::Identity();
  current_.reference = kNoId;
  last_used_depth_ = !has_start_points();
  begun_at_ = current_.frame->time;
}

// In a map that was tracked for a short time only, the camera was not found for longer: in images
// that another map could begin with, not in darkness.
bool OrbTracker::gives_up_map() {
  const double tracked = last_.frame ? last_.frame->time - begun_at_ : kYoungMap;
  if (tracked >= kYoungMap || !can_start()) return false;
  searched_ += std::min(current_.frame->time - previous_time_, kLongestInterval);
  return searched_ > std::max(kLeastSearch, tracked);
}

TrackResult OrbTracker::begun_anew(TrackHints hints) {
  current_.clear_matches();
  start();
  last_ = {};
  last_keyframe_ = kNoId;
  inliers_ = 0;
  bridged_ = false;
  visible_.clear();
  evidence_.clear();
  relocalised_at_.reset();
  state_ = TrackState::kWaiting;
  depth_registration_.discard();
  depth_registration_.forget_references();
  TrackResult result = tracked(SparseMap(), hints);
  result.begins_anew = true;
  return result;
}

// Whether the surfaces in view alone would constrain a pose.
bool OrbTracker::surfaces_suffice() {
  return options_.register_depth && is_well_constrained(depth_registration_.information_of_view());
}

}  // namespace stillpoint::orb_slam
