// Tracker `orb`: the pose of each frame in the sparse map (DS-SLAM III-A; ORB-SLAM2).
#pragma once

#include <optional>
#include <vector>

#include "orb_slam/constant_velocity.hpp"
#include "orb_slam/depth_registration.hpp"
#include "orb_slam/local_map.hpp"
#include "orb_slam/moving_area.hpp"
#include "orb_slam/observed_frame.hpp"
#include "orb_slam/relocaliser.hpp"
#include "orb_slam/static_evidence.hpp"
#include "orb_slam/tracker_options.hpp"
#include "stillpoint/contracts/tracker.hpp"

namespace stillpoint::orb_slam {

class OrbTracker final : public Tracker {
 public:
  using Options = TrackerOptions;

  explicit OrbTracker(Options options);

  PreparedFramePtr prepare(FramePtr frame) override;
  TrackResult track(PreparedFramePtr prepared, const StaticWeights& weights, const SparseMap& map,
                    TrackHints hints) override;

 private:
  int solve(const SparseMap& map, const PoseTerm& term = {});
  void begin_with(const SparseMap& map);
  bool has_start_points() const;
  bool can_start();
  void start();
  bool surfaces_suffice();
  bool gives_up_map();
  void follow_map(const SparseMap& map);
  void predict_pose();
  double seconds_since_last() const;
  bool is_recent() const;
  int match_last_frame(const SparseMap& map);
  bool track_with_motion(const SparseMap& map);
  bool track_by_appearance(const SparseMap& map);
  bool relocalise(const SparseMap& map);
  bool is_supported(const SparseMap& map) const;
  bool track_local_map(const SparseMap& map);
  void search_local_map(const SparseMap& map);
  bool track_with_depth(const SparseMap& map);
  void match_neighbour(const SparseMap& map);
  bool register_depth(const SparseMap& map);

  TrackResult tracked(const SparseMap& map, TrackHints hints);
  TrackResult begun_anew(TrackHints hints);
  TrackResult not_tracked(TrackState state);
  void remember_view();
  PoseUncertainty uncertainty(const SparseMap& map) const;
  void update_velocity();
  KeyFrame make_keyframe(KeyFrameId id);

  Options options_;
  OrbExtractor extractor_;
  Relocaliser relocaliser_;
  MovingArea moving_area_;

  ObservedFrame current_;
  ObservedFrame last_;                // the last one with a pose
  KeyFrameId last_keyframe_ = kNoId;  // id of `last_`, when it became one
  std::optional<Pose> prediction_;    // of this frame's pose; none where it failed
  ConstantVelocity velocity_;
  TrackState state_ = TrackState::kWaiting;
  int inliers_ = 0;  // landmarks
  MostInliers most_inliers_;
  bool bridged_ = false;  // the pose of this frame needed temporary points
  DepthRegistration depth_registration_;
  bool last_used_depth_ = false;
  PoseUncertainty last_uncertainty_;  // of this frame, once it is tracked; before, of `last_`

  double begun_at_ = 0;                       // seconds, the map of this recording
  double previous_time_ = 0;                  // seconds, the frame before, tracked or not
  double searched_ = 0;                       // seconds since it was lost, of usable images
  std::optional<double> relocalised_at_;      // seconds, the last time; none: never
  std::optional<KeyFrameId> first_keyframe_;  // of this recording: others came with the map
  double last_keyframe_at_ = -1e300;          // seconds, the newest key frame of this recording
  double last_view_at_ = -1e300;              // seconds, the newest view of remember_view()
  std::vector<LandmarkId> visible_;           // landmarks that should be seen in this frame
  EvidenceByLandmark evidence_;
};

}  // namespace stillpoint::orb_slam
