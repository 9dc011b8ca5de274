#include "orb_slam/keyframe_policy.hpp"

#include <algorithm>

#include "orb_slam/landmark_geometry.hpp"

namespace stillpoint::orb_slam {
namespace {

// Inliers, of the matches of the reference: with fewer, tracking may be lost before mapping is
// free.
constexpr double kUrgentRatio = 0.25;
// Frames between two key frames where depth gives the pose: unstable corners would ask for one
// every time.
constexpr int kMinFramesBetweenByDepth = 5;

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
  if (depths.empty()) return 0;
  const auto middle = depths.begin() + static_cast<std::ptrdiff_t>(depths.size() / 2);
  std::ranges::nth_element(depths, middle);
  return *middle;
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
  v("keyframe_max_frames", max_frames_between,
    {.min = 1, .unit = "frames", .help = "allowed after this long even if mapping is busy"});
  v("keyframe_tracked_ratio", min_tracked_ratio,
    {.min = 0,
     .max = 1,
     .help = "new key frame when less than this share of the reference's landmarks is tracked"});
  v("keyframe_moved", moved,
    {.min = 0,
     .help = "translation in median depths plus rotation in radians that counts as moved"});
  v("keyframe_moved_ratio", moved_tracked_ratio,
    {.min = 0, .max = 1, .help = "as keyframe_tracked_ratio, once the camera has moved"});
  v("keyframe_min_inliers", min_inliers,
    {.min = 6, .help = "no key frame from a pose with fewer landmark inliers"});
  v("close_depth", close_depth,
    {.min = 0.1, .unit = "m", .help = "nearer points have depth that can constrain translation"});
  v("keyframe_min_close", min_close,
    {.min = 0,
     .help = "new key frame when fewer close landmarks are tracked and enough could be created"});
  v("keyframe_max_close_untracked", max_close_untracked,
    {.min = 0, .help = "close points without a landmark, above which enough could be created"});
}

TrackingQuality tracking_quality(const ObservedFrame& frame, const SparseMap& map, int inliers,
                                 int frames_since_last, const KeyFrameOptions& options) {
  TrackingQuality quality{.inliers = inliers, .frames_since_last = frames_since_last};
  if (const KeyFrame* reference = map.keyframe(frame.reference)) {
    quality.reference_matches = established_landmarks(*reference, map);
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
  if (q.depth_registered) return needs_close && q.frames_since_last >= kMinFramesBetweenByDepth;
  if (q.inliers < options.min_inliers) return false;
  // If the camera has not moved, landmarks are missing because a person occludes them.
  const double least =
      q.motion < options.moved ? options.min_tracked_ratio : options.moved_tracked_ratio;
  const bool view_changed = q.inliers < least * q.reference_matches;
  if (!needs_close && !view_changed) return false;
  const bool urgent = needs_close || q.inliers < kUrgentRatio * q.reference_matches;
  return urgent || q.frames_since_last >= options.max_frames_between || !hints.mapping_waiting;
}

}  // namespace stillpoint::orb_slam
