// Tracker `orb`: the pose of each frame in the sparse map (DS-SLAM III-A; ORB-SLAM2).
#pragma once

#include <optional>
#include <vector>

#include "orb_slam/depth_anchor.hpp"
#include "orb_slam/keyframe_policy.hpp"
#include "orb_slam/local_map.hpp"
#include "orb_slam/observed_frame.hpp"
#include "orb_slam/orb_extractor.hpp"
#include "orb_slam/relocaliser.hpp"
#include "orb_slam/static_evidence.hpp"
#include "stillpoint/contracts/tracker.hpp"

namespace stillpoint::orb {

class OrbTracker final : public Tracker {
 public:
  struct Options {
    OrbOptions orb;
    KeyFrameOptions keyframe;
    int min_start_points = 100;
    int min_inliers = 30;
    int min_bridge_points = 50;
    int local_keyframes = 80;
    double motion_window = 15.0;
    double local_window = 3.0;
    double proving_time = 0.0;
    double most_features = 1.0;
    bool hold_by_depth = true;

    void visit(OptionVisitor& visitor);
  };

  explicit OrbTracker(Options options);

  void prepare(FramePtr frame) override;
  TrackResult track(FramePtr frame, const StaticWeights& weights, const SparseMap& map,
                    TrackHints hints) override;

 private:
  double feature_share() const;
  int solve(const SparseMap& map, const PoseTerm& term = {});
  bool start();
  bool surfaces_suffice();
  void follow_map(const SparseMap& map);
  void predict_pose();
  int match_last_frame(const SparseMap& map);
  bool track_with_motion(const SparseMap& map);
  bool track_by_appearance(const SparseMap& map);
  bool track_local_map(const SparseMap& map);
  void search_local_map(const SparseMap& map);
  bool well_held() const;
  bool track_with_depth(const SparseMap& map);
  void match_neighbour(const SparseMap& map);
  bool hold_by_depth(const SparseMap& map);
  bool landmarks_agree() const;
  QuadraticCost motion_prior() const;
  const DepthView& depth_view();

  TrackResult tracked(const SparseMap& map, TrackHints hints);
  TrackResult not_tracked(TrackState state);
  PoseUncertainty uncertainty(const SparseMap& map) const;
  void update_velocity();
  KeyFrame make_keyframe();

  Options options_;
  OrbExtractor extractor_;
  Relocaliser relocaliser_;
  cv::Mat unmapped_;     // where the last frame's features could have no landmark: not 0, CV_8U
  double hidden_ = 0.0;  // share of the image that `unmapped_` is
  double last_company_ = -1e300;  // seconds: of the last frame in which it was more than noise

  ObservedFrame current_;
  ObservedFrame last_;                // the last one with a pose
  KeyFrameId last_keyframe_ = kNoId;  // id of `last_`, when it became one
  std::optional<Pose> prediction_;    // of this frame's pose, unless it proved wrong
  std::optional<Pose> velocity_;      // last camera from the one before it
  double velocity_seconds_ = 0.0;     // over which velocity_ was measured
  TrackState state_ = TrackState::kWaiting;
  int inliers_ = 0;                        // landmarks
  bool bridged_ = false;                   // the pose of this frame needed temporary points
  StaticWeights weights_;                  // of this frame
  std::optional<DepthView> depth_view_;    // of this frame, once it is needed
  std::optional<PlaneRegistration> held_;  // of this frame, when its pose needed it
  bool last_held_ = false;
  DepthAnchor anchor_;
  PoseUncertainty last_uncertainty_;  // of this frame, once it is tracked; before, of `last_`

  std::optional<KeyFrameId> first_keyframe_;  // of this recording: others came with the map
  KeyFrameId next_keyframe_ = 0;
  std::uint32_t last_keyframe_index_ = 0;  // frame index of the newest key frame
  std::vector<LandmarkId> visible_;        // landmarks that should be seen in this frame
  EvidenceByLandmark evidence_;
};

}  // namespace stillpoint::orb
