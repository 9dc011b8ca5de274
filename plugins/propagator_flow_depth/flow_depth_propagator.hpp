// Propagates labels to the current frame by optical flow and depth.
#pragma once

#include <deque>
#include <optional>
#include <vector>

#include "propagator_flow_depth/followed_object.hpp"
#include "propagator_flow_depth/found_objects.hpp"
#include "propagator_flow_depth/view.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::propagator_flow_depth {

/// Every object keeps the mask that the network gave it in its reference view, and points followed
/// on it since. In the current view the mask is where these points have gone to, with its outline
/// on the edges of the depth image.
class FlowDepthPropagator final : public Propagator {
 public:
  struct Options {
    int points = 40;               ///< followed per object
    double max_flow_error = 1.0;   ///< px, forward-backward error
    int min_points = 5;            ///< tracked, on an object that the network misses
    double keep_seconds = 1.5;     ///< that such an object is kept
    int max_misses = 5;            ///< consecutive results that may miss an object
    int margin = 8;                ///< px that outlines may move outwards to a depth edge
    double depth_tolerance = 0.1;  ///< metres at 2 m
    int min_object_pixels = 100;   ///< smaller objects are left out

    void visit(OptionVisitor& visitor);
  };

  explicit FlowDepthPropagator(Options options) : options_(options) {}

  Segmentation propagate(const Segmentation& segmentation, const Frame& from,
                         const Frame& to) override;

 private:
  int rim() const;  // px of views: uncertainty of outlines
  View spare_view();
  const View& view_of(const Frame& frame);
  const View& followed_near(const View& view) const;
  void associate(const Segmentation& segmentation, const View& view);
  void update_detected(FollowedObject& object, const FoundObject& detection, double share,
                       const View& view) const;
  void update_missed(FollowedObject& object, const View& view) const;
  std::optional<FollowedObject> missed_part(const FollowedObject& object, const View& before,
                                            const cv::Mat& found, const View& view);
  void set_reference(FollowedObject& object, const cv::Mat& mask, cv::Rect box,
                     const View& view) const;
  void propagate_tracks();
  void predict_mask(FollowedObject& object, const View& view) const;
  bool supported(const FollowedObject& object, const View& view) const;
  void renew_reference(FollowedObject& object, const View& view) const;
  void compose_instances(View& view);
  Segmentation result(const View& view, const Frame& frame) const;

  Options options_;
  std::vector<FollowedObject> objects_;
  std::deque<View> history_;               // in order of frames, the current one last
  std::uint32_t segmented_frame_ = kNoId;  // of the newest segmentation
  bool has_labels_ = false;                // whether there have been any
  int next_id_ = 0;
};

}  // namespace stillpoint::propagator_flow_depth
