// Contract: the camera's pose in the sparse map (paper III-A). Thread 1.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/pose_uncertainty.hpp"
#include "stillpoint/contracts/sparse_map.hpp"
#include "stillpoint/contracts/static_weights.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

enum class TrackState {
  kWaiting,  ///< no map yet and no start possible; later, of frames before the map was begun anew
  kTracking,
  kLost
};
/// "waiting", "tracking" or "LOST", for messages.
STILLPOINT_EXPORT const char* name_of(TrackState state);

/// A feature as tracking used it, for pictures and statistics.
struct TrackedFeature {
  cv::Point2f pixel;  ///< px
  enum class Use { kUnmatched, kInlier, kOutlier, kMoving } use = Use::kUnmatched;
};

/// The world pose is world_from_keyframe(reference) * reference_from_camera, so that trajectories
/// follow when mapping or a loop moves the reference.
struct TrackResult {
  TrackState state = TrackState::kWaiting;
  /// A key frame of the map, or the one that this frame becomes. Valid only while tracking: before
  /// the first key frame there is none.
  KeyFrameId reference = kNoId;
  Pose reference_from_camera = Pose::Identity();
  Pose world_from_camera = Pose::Identity();   ///< at the time of tracking
  int features = 0;                            ///< extracted
  int matches = 0;                             ///< with a landmark
  int inliers = 0;                             ///< of those, fitting the pose
  std::optional<PoseUncertainty> uncertainty;  ///< of the pose; nothing: not known
  bool depth_registered = false;               ///< landmarks alone did not constrain the pose
  std::vector<TrackedFeature> tracked;         ///< per feature
  std::optional<KeyFrame> keyframe;            ///< to be inserted
  /// The map is cleared before `keyframe` is inserted, which begins a new one at the origin; the
  /// frames before count as not tracked. For a map that is lost as soon as it has begun.
  bool begins_anew = false;
};

/// What a tracker has found in a frame before it knows weights and map, features for instance. Each
/// tracker derives its own.
class STILLPOINT_EXPORT PreparedFrame {
 public:
  explicit PreparedFrame(FramePtr prepared) : frame(std::move(prepared)) {}
  virtual ~PreparedFrame();
  PreparedFrame(const PreparedFrame&) = delete;
  PreparedFrame& operator=(const PreparedFrame&) = delete;

  const FramePtr frame;
};
using PreparedFramePtr = std::unique_ptr<PreparedFrame>;

struct TrackHints {
  KeyFrameId next_keyframe = 0;  ///< the id of the key frame, if this frame becomes one
  bool mapping_waiting = false;  ///< a key frame is already waiting for the local mapper
  bool localise_only = false;    ///< the map stays as it is: no key frames
  bool may_begin_anew = false;   ///< the map is of this run: see TrackResult::begins_anew
};

/// Called for every frame, in order: prepare(), then track() with what it gave. When a run is
/// stopped in between, track() is left out.
class STILLPOINT_EXPORT Tracker {
 public:
  static constexpr const char* kKind = "tracker";
  static constexpr std::uint32_t kApi = 2;  ///< see kPluginApi
  virtual ~Tracker();

  /// Everything that needs neither weights nor map; overlaps the network (paper III-D).
  virtual PreparedFramePtr prepare(FramePtr frame) = 0;

  /// `prepared` is what prepare() gave for the frame, never null. Never writes the map, a snapshot
  /// in which the newest key frame can be missing yet; it is valid during the call, and a copy may
  /// be kept. With an empty map, the first usable frame becomes the first key frame, at the origin.
  virtual TrackResult track(PreparedFramePtr prepared, const StaticWeights& weights,
                            const SparseMap& map, TrackHints hints) = 0;
};

}  // namespace stillpoint
