#include "orb_slam/keyframe_policy.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "orb_slam/landmark_geometry.hpp"
#include "stillpoint/support/median.hpp"

namespace stillpoint::orb_slam {
namespace {

// Inliers, of the landmarks in view of the reference: with fewer, tracking may be lost before
// mapping is free.
constexpr double kUrgentRatio = 0.25;
// Between two key frames where depth gives the pose: unstable corners would ask for one every time.
constexpr double kMinSecondsBetweenByDepth = 0.15;
// Likewise while another one waits: in a fast turn near points run out every time, and the queue
// would fill and hold up tracking.
constexpr double kMinSecondsBetweenWhileWaiting = 0.08;

// Landmarks of the reference key frame that others observe as well; in a young map, all of them.
int established_landmarks(const KeyFrame& keyframe, const SparseMap& map) {
  const std::size_t min_observations = map.keyframe_count() <= 2 ? 1 : 2;
  int count = 0;
  for (const LandmarkId id : keyframe.landmarks)
    if (id != kNoId && map.landmark(id)->observations.size() >= min_observations) ++count;
  return count;
}

// Of the features that have one, in metres; 0 without any.
double median_depth(const Features& features) {
  std::vector<float> depths;
  std::ranges::copy_if(features.depth, std::back_inserter(depths), [](float z) { return z > 0; });
  return median(std::move(depths));
}

// Approximate image motion, in focal lengths.
double motion_since(const KeyFrame& reference, const ObservedFrame& frame) {
  const Pose motion = reference.world_from_camera.inverse() * frame.world_from_camera;
  const double depth = median_depth(*frame.features);
  const double way = depth > 0 ? motion.translation().norm() / depth : 0;
  return way + rotation_angle(motion);
}

}  // namespace

void KeyFrameOptions::visit(OptionVisitor& v) {
  v("keyframe_max_seconds", max_seconds_between,
    {.min = 0,
     .unit = "s",
     .help = "time since the last key frame from which a new one is made even while another waits "
             "for local mapping"});
  v("keyframe_tracked_ratio", min_tracked_ratio,
    {.min = 0,
     .max = 1,
     .help = "while the camera stands still, a new key frame is made when less than this share of "
             "the landmarks in view of the reference key frame is tracked: those that it shares "
             "with others, or the most tracked with it so far; larger: more key frames"});
  v("keyframe_moved", moved,
    {.min = 0,
     .help = "motion since the reference key frame from which the camera counts as moved: "
             "translation / median depth + rotation in radians"});
  v("keyframe_moved_ratio", moved_tracked_ratio,
    {.min = 0, .max = 1, .help = "the same share once the camera has moved, see keyframe_moved"});
  v("keyframe_min_inliers", min_inliers,
    {.min = 6,
     .help = "a frame with fewer landmark inliers becomes no key frame, unless temporary points or "
             "depth give its pose"});
  v("close_depth", close_depth,
    {.min = 0.1,
     .unit = "m",
     .help = "points nearer than this are close: their depth constrains the translation (ThDepth "
             "of ORB-SLAM2)"});
  v("keyframe_min_close", min_close,
    {.min = 0,
     .help = "a new key frame is made when fewer close landmarks than this are tracked, if it "
             "could add enough, see keyframe_max_close_untracked"});
  v("keyframe_max_close_untracked", max_close_untracked,
    {.min = 0,
     .help = "a new key frame for keyframe_min_close needs more close points without a landmark "
             "than this; larger: fewer key frames"});
}

int MostInliers::update(KeyFrameId reference, int inliers) {
  most_ = reference == reference_ ? std::max(most_, inliers) : inliers;
  reference_ = reference;
  return most_;
}

TrackingQuality tracking_quality(const ObservedFrame& frame, const SparseMap& map, int inliers,
                                 double seconds_since_last, const KeyFrameOptions& options) {
  TrackingQuality quality{.inliers = inliers, .seconds_since_last = seconds_since_last};
  if (const KeyFrame* reference = map.keyframe(frame.reference)) {
    quality.established = established_landmarks(*reference, map);
    quality.motion = motion_since(*reference, frame);
  }
  for (std::uint32_t i = 0; i < frame.features->size(); ++i) {
    const float depth = frame.features->depth[i];
    if (depth <= 0 || depth > options.close_depth || !frame.usable(i)) continue;
    const bool tracked = frame.landmarks[i] != kNoId && !frame.outlier[i];
    const bool can_be_mapped =
        frame.track_weights[i] >= kMinMapWeight && frame.map_weights[i] >= kMinMapWeight;
    quality.close_tracked += tracked ? 1 : 0;
    quality.close_untracked += !tracked && can_be_mapped ? 1 : 0;
  }
  return quality;
}

bool needs_keyframe(const TrackingQuality& q, TrackHints hints, const KeyFrameOptions& options) {
  const bool needs_close =
      q.close_tracked < options.min_close && q.close_untracked > options.max_close_untracked;
  if (q.depth_registered) return needs_close && q.seconds_since_last >= kMinSecondsBetweenByDepth;
  if (q.inliers < options.min_inliers) return false;
  // If the camera has not moved, landmarks are missing because a person occludes them.
  const double least =
      q.motion < options.moved ? options.min_tracked_ratio : options.moved_tracked_ratio;
  // ORB-SLAM2 takes the established landmarks alone. Of a part of the room not seen before the
  // reference shares few with other key frames, so that the next one would come late, share fewer
  // still, and so on.
  const int in_view = std::max(q.established, q.most_inliers);
  const bool view_changed = q.inliers < least * in_view;
  if (!needs_close && !view_changed) return false;
  const bool nearly_lost = q.inliers < kUrgentRatio * in_view;
  const bool urgent =
      nearly_lost || (needs_close && q.seconds_since_last >= kMinSecondsBetweenWhileWaiting);
  return urgent || q.seconds_since_last >= options.max_seconds_between || !hints.mapping_waiting;
}

}  // namespace stillpoint::orb_slam
