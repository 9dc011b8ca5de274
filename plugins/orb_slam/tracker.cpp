#include "orb_slam/tracker.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "orb_slam/appearance.hpp"
#include "orb_slam/landmark_geometry.hpp"
#include "orb_slam/pose_uncertainty.hpp"
#include "orb_slam/tracked_features.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr int kMinMotionMatches = 20;  // fewer: search again in a wider window
constexpr int kMinMotionInliers = 20;  // fewer, or a smaller share: do not trust the prediction
constexpr double kMinMotionShare = 0.5;
// An image with so many features, of which so small a share matches the last frame, shows another
// place; unless the last frame, which was registered by depth, had no texture.
constexpr int kManyFeatures = 500;
constexpr double kMinMatchedShare = 0.1;
constexpr double kRecentSeconds = 1.0;  // afterwards the camera may be anywhere
constexpr double kSteadySeconds = 0.5;  // that a velocity may be taken to last
constexpr double kViewInterval = 0.5;   // seconds between remembered views, while localising
constexpr double kSettled = 0.2;        // seconds without a key frame after relocalisation

/// Its features, with their depths.
struct PreparedOrbFrame final : PreparedFrame {
  explicit PreparedOrbFrame(ObservedFrame features)
      : PreparedFrame(features.frame), observed(std::move(features)) {}
  ObservedFrame observed;
};

}  // namespace

OrbTracker::OrbTracker(Options options) : options_(options), extractor_(options.orb) {}

PreparedFramePtr OrbTracker::prepare(FramePtr frame) {
  Features features = extractor_.extract(frame->gray, moving_area_.mask(),
                                         moving_area_.feature_factor(options_.max_feature_factor));
  return std::make_unique<PreparedOrbFrame>(observe(std::move(frame), std::move(features)));
}

// While dynamic objects are around, new landmarks may lie on an undetected one.
int OrbTracker::solve(const SparseMap& map, const PoseTerm& term) {
  const double probation = moving_area_.recent(current_.frame->time) ? options_.probation : 0.0;
  return solve_pose(current_, map, probation, *first_keyframe_, term);
}

TrackResult OrbTracker::track(PreparedFramePtr prepared, const StaticWeights& weights,
                              const SparseMap& map, TrackHints hints) {
  current_ = std::move(static_cast<PreparedOrbFrame&>(*prepared).observed);
  current_.set_weights(weights);
  moving_area_.update(weights, current_.frame->time);
  if (!first_keyframe_) begin_with(map);
  depth_registration_.begin(current_.frame, weights);
  prediction_.reset();
  if (map.empty()) {
    if (hints.localise_only || !can_start()) return not_tracked(TrackState::kWaiting);
    start();
    return tracked(map, hints);
  }

  follow_map(map);
  const bool following = state_ == TrackState::kTracking;
  bool found =
      following && (track_with_motion(map) || track_by_appearance(map)) && track_local_map(map);
  if (!found && !following) found = relocalise(map);
  if (!found && (following || is_recent())) found = track_with_depth(map);
  if (!found && following) found = relocalise(map);
  if (found) return tracked(map, hints);
  return hints.may_begin_anew && gives_up_map() ? begun_anew(hints)
                                                : not_tracked(TrackState::kLost);
}

// Mapping may have moved, fused or removed what the last frame refers to.
void OrbTracker::follow_map(const SparseMap& map) {
  if (!last_.frame) return;
  if (last_.reference < map.keyframe_id_end())
    last_.world_from_camera =
        map.world_from_keyframe(last_.reference) * last_.reference_from_camera;
  if (const KeyFrame* keyframe = map.keyframe(last_keyframe_)) {
    last_.landmarks = keyframe->landmarks;  // now with those that its insertion made
    last_keyframe_ = kNoId;
  }
  for (LandmarkId& id : last_.landmarks) id = map.current_id(id);
}

void OrbTracker::predict_pose() {
  prediction_.reset();
  if (velocity_.has_value() && seconds_since_last() <= kSteadySeconds)
    prediction_ = velocity_.predict(last_.world_from_camera, seconds_since_last());
  current_.world_from_camera = prediction_.value_or(last_.world_from_camera);
}

double OrbTracker::seconds_since_last() const { return current_.frame->time - last_.frame->time; }

bool OrbTracker::is_recent() const { return last_.frame && seconds_since_last() <= kRecentSeconds; }

int OrbTracker::match_last_frame(const SparseMap& map) {
  const Pose prediction = current_.world_from_camera.inverse();
  const std::vector<Target> targets = targets_of(last_, map);
  const int matches = match_projected(current_, targets, prediction, options_.motion_window, 1);
  if (matches >= kMinMotionMatches) return matches;
  return match_projected(current_, targets, prediction, 2 * options_.motion_window, 1);
}

bool OrbTracker::track_with_motion(const SparseMap& map) {
  if (!velocity_.has_value()) return false;
  predict_pose();
  const int matches = match_last_frame(map);
  const int inliers = solve(map);
  current_.drop_outliers();
  return inliers >= kMinMotionInliers && inliers >= kMinMotionShare * matches;
}

// Independent of any prediction, which it forgets: for fast rotation, and where the prediction led
// to a local minimum.
bool OrbTracker::track_by_appearance(const SparseMap& map) {
  prediction_.reset();
  if (locate_by_appearance(current_, targets_of(last_, map), map) >= options_.min_inliers)
    return true;
  const KeyFrame* reference = map.keyframe(last_.reference);
  return reference &&
         locate_by_appearance(current_, targets_of(*reference, map), map) >= options_.min_inliers;
}

bool OrbTracker::relocalise(const SparseMap& map) {
  prediction_.reset();
  if (state_ == TrackState::kTracking) relocaliser_.begin(last_.reference);
  const auto holds = [&] {
    depth_registration_.discard();
    return track_local_map(map) && is_supported(map);
  };
  if (!(is_recent() && track_by_appearance(map) && holds()) &&
      !relocaliser_.find(current_, map, holds))
    return false;
  relocalised_at_ = current_.frame->time;
  return true;
}

bool OrbTracker::is_supported(const SparseMap& map) const {
  const Eigen::Vector3d way =
      current_.world_from_camera.translation() - last_.world_from_camera.translation();
  const double least =
      last_.frame ? required_support(way.norm(), seconds_since_last()) : required_support(0, 0);
  const int possible = std::min(count_unoccluded(current_, map, visible_), current_.usable_count());
  return inliers_ >= least * possible;
}

bool OrbTracker::track_local_map(const SparseMap& map) {
  search_local_map(map);
  const Pose prior = current_.world_from_camera;
  const auto temporary =
      std::exchange(current_.temporary, decltype(current_.temporary)(current_.features->size()));
  inliers_ = solve(map);
  bridged_ = inliers_ < options_.min_inliers;
  if (!bridged_) {
    if (!is_well_constrained(current_.information)) register_depth(map);
    return true;
  }
  // A view with hardly any landmarks: tracked on the points of the last frame, it becomes a key
  // frame, whose landmarks enter the map.
  current_.temporary = temporary;
  current_.world_from_camera = prior;
  return current_.reference != kNoId && solve(map) >= options_.min_bridge_points;
}

// Where neither the last frame nor the map gives enough inliers: starts from the prediction and
// uses surfaces and whatever landmarks match.
bool OrbTracker::track_with_depth(const SparseMap& map) {
  if (!options_.register_depth) return false;
  predict_pose();
  if (state_ == TrackState::kLost) {
    prediction_ = last_.world_from_camera;
    current_.reference = kNoId;  // of a place that was not accepted
  }
  const int matches = match_last_frame(map);
  const int usable = current_.usable_count();
  if (!last_used_depth_ && usable >= kManyFeatures && matches < kMinMatchedShare * usable)
    return false;
  if (!register_depth(map)) return false;
  current_.drop_outliers();
  if (current_.matched() < kMinLandmarksWithDepth) match_neighbour(map);
  search_local_map(map);
  bridged_ = false;
  return register_depth(map);
}

// Landmarks that come into view again after there were none: the pose may have drifted meanwhile,
// hence the wider window.
void OrbTracker::match_neighbour(const SparseMap& map) {
  const KeyFrame* neighbour = map.keyframe(current_.reference);
  if (!neighbour) return;
  match_projected(current_, targets_of(*neighbour, map), current_.world_from_camera.inverse(),
                  2 * options_.motion_window, 1);
}

bool OrbTracker::register_depth(const SparseMap& map) {
  if (!options_.register_depth) return false;
  const QuadraticCost motion =
      prediction_ ? motion_prior(*prediction_, seconds_since_last()) : QuadraticCost();
  if (!depth_registration_.refine(current_, map, motion,
                                  [&](const PoseTerm& term) { solve(map, term); }))
    return false;
  inliers_ = current_.inlier_count();
  return true;
}

void OrbTracker::search_local_map(const SparseMap& map) {
  const LocalMap local = local_map_around(current_.landmarks, map, options_.local_keyframes);
  current_.reference = local.reference;
  if (local.reference == kNoId && map.keyframe(last_.reference))
    current_.reference = last_.reference;

  visible_.clear();
  search(current_, local, map, options_.local_window, visible_);
}

TrackResult OrbTracker::tracked(const SparseMap& map, TrackHints hints) {
  TrackResult result{.state = TrackState::kTracking};
  result.world_from_camera = current_.world_from_camera =
      orthonormalised(current_.world_from_camera);
  result.features = static_cast<int>(current_.features->size());
  result.matches = current_.matched();
  result.inliers = inliers_;
  result.uncertainty = last_uncertainty_ = uncertainty(map);
  result.depth_registered = depth_registration_.refined();
  result.tracked = tracked_features(current_);

  TrackingQuality quality = tracking_quality(
      current_, map, inliers_, current_.frame->time - last_keyframe_at_, options_.keyframe);
  quality.most_inliers = most_inliers_.update(current_.reference, inliers_);
  quality.depth_registered = depth_registration_.refined();
  const bool unknown_view = (bridged_ || depth_registration_.shows_new_surfaces()) &&
                            last_keyframe_ == kNoId;  // the last one is in the map
  if (state_ == TrackState::kLost) relocalised_at_ = current_.frame->time;
  const bool settled = !relocalised_at_ || current_.frame->time - *relocalised_at_ >= kSettled;
  const bool keep =
      !hints.localise_only && settled &&
      (map.empty() || unknown_view || needs_keyframe(quality, hints, options_.keyframe));
  // A doubtful pose is no witness against the map.
  if (settled && !bridged_ && !result.uncertainty->poorly_constrained())
    add_static_evidence(current_, map, visible_, last_.frame ? seconds_since_last() : 0, evidence_);
  current_.drop_outliers();
  current_.drop_temporary();
  last_keyframe_ = kNoId;
  if (keep) {
    result.keyframe = make_keyframe(hints.next_keyframe);
    current_.reference = last_keyframe_ = result.keyframe->id;
    current_.reference_from_camera = Pose::Identity();
  } else {
    current_.reference_from_camera =
        map.world_from_keyframe(current_.reference).inverse() * current_.world_from_camera;
  }
  result.reference = current_.reference;
  result.reference_from_camera = current_.reference_from_camera;
  if (hints.localise_only) remember_view();

  update_velocity();
  state_ = TrackState::kTracking;
  searched_ = 0;
  if (!map.empty()) last_used_depth_ = depth_registration_.refined();
  previous_time_ = current_.frame->time;
  last_ = std::move(current_);
  return result;
}

// A map from a file has no depth images, and localising adds no key frames.
void OrbTracker::remember_view() {
  if (!options_.register_depth || bridged_ || depth_registration_.refined() ||
      current_.frame->time - last_view_at_ < kViewInterval)
    return;
  depth_registration_.add_reference(current_.reference, current_.reference_from_camera);
  last_view_at_ = current_.frame->time;
}

// Temporary points are no better known than the frame that measured them.
PoseUncertainty OrbTracker::uncertainty(const SparseMap& map) const {
  if (map.empty()) return {.covariance = Matrix6d::Zero()};  // the origin
  const Matrix6d& chain = current_.temporary_information;
  if (chain.isZero()) return uncertainty_of(current_.information);
  const Matrix6d chained = last_uncertainty_.covariance + uncertainty_of(chain).covariance;
  return uncertainty_of(current_.information - chain + inverse(chained));
}

void OrbTracker::update_velocity() {
  if (state_ != TrackState::kTracking || !last_.frame) {
    velocity_.reset();
    return;
  }
  velocity_.update(current_.world_from_camera.inverse() * last_.world_from_camera,
                   seconds_since_last(), depth_registration_.refined());
}

TrackResult OrbTracker::not_tracked(TrackState state) {
  TrackResult result{.state = state};
  result.features = static_cast<int>(current_.features->size());
  current_.clear_matches();
  result.tracked = tracked_features(current_);
  state_ = state;
  previous_time_ = current_.frame->time;
  velocity_.reset();
  return result;
}

KeyFrame OrbTracker::make_keyframe(KeyFrameId id) {
  KeyFrame keyframe{.id = id,
                    .frame = current_.frame->index,
                    .time = current_.frame->time,
                    .world_from_camera = current_.world_from_camera,
                    .covariance = depth_registration_.refined() || bridged_
                                      ? last_uncertainty_.covariance
                                      : Matrix6d(Matrix6d::Zero()),
                    .camera = current_.frame->camera,
                    .features = current_.features,
                    .track_weights = current_.track_weights,
                    .map_weights = current_.map_weights,
                    .landmarks = current_.landmarks};
  for (auto& [landmark, evidence] : evidence_) {
    evidence.landmark = landmark;
    keyframe.evidence.push_back(evidence);
  }
  std::sort(keyframe.evidence.begin(), keyframe.evidence.end(),
            [](const auto& a, const auto& b) { return a.landmark < b.landmark; });
  evidence_.clear();
  last_keyframe_at_ = current_.frame->time;
  if (options_.register_depth) depth_registration_.add_reference(keyframe.id);
  return keyframe;
}

}  // namespace stillpoint::orb_slam
