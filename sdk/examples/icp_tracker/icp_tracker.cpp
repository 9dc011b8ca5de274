// Tracker `icp`: odometry from depth alone, against the last key frame. It has no features, so it
// gives none: no pyramid, no descriptors, no landmarks.
#include <memory>
#include <stillpoint/sdk.hpp>
#include <utility>

#include "surface.hpp"

namespace {

using namespace stillpoint;

/// Made beside the network, since it needs neither weights nor map.
struct PreparedSurface final : PreparedFrame {
  PreparedSurface(FramePtr prepared, int step)
      : PreparedFrame(std::move(prepared)),
        surface(std::make_shared<const Surface>(*frame, step)) {}
  std::shared_ptr<const Surface> surface;
};

class IcpTracker final : public Tracker {
 public:
  struct Options {
    int step = 4;
    double reach = 0.1;
    double keyframe_distance = 0.15;
    double keyframe_angle = 10.0;
    double keyframe_share = 0.4;

    void visit(OptionVisitor& v) {
      v("step", step, {.min = 1, .max = 32, .unit = "px", .help = "between pixels that are used"});
      v("reach", reach,
        {.min = 0.001, .max = 1, .unit = "m", .help = "largest distance of correspondences"});
      v("keyframe_distance", keyframe_distance,
        {.min = 0, .unit = "m", .help = "from the last key frame to the next"});
      v("keyframe_angle", keyframe_angle,
        {.min = 0, .max = 180, .unit = "degrees", .help = "likewise"});
      v("keyframe_share", keyframe_share,
        {.min = 0, .max = 1, .help = "share of correspondences; below it, a key frame is made"});
    }
  };
  explicit IcpTracker(Options options) : options_(options) {}

  PreparedFramePtr prepare(FramePtr frame) override {
    return std::make_unique<PreparedSurface>(std::move(frame), options_.step);
  }

  TrackResult track(PreparedFramePtr prepared, const StaticWeights& weights, const SparseMap& map,
                    TrackHints hints) override {
    const auto& current = static_cast<const PreparedSurface&>(*prepared);
    if (!reference_ && !map.empty()) return {.state = TrackState::kLost};  // a map of another run
    if (!reference_) return hints.localise_only ? TrackResult{} : started(current, hints);
    const Pose guess = reference_from_last_ * motion_;
    const auto found =
        registered(*reference_, *current.surface, weights.track, guess, options_.reach);
    if (!found) return {.state = TrackState::kLost};
    motion_ = reference_from_last_.inverse() * found->reference_from_current;
    reference_from_last_ = found->reference_from_current;
    TrackResult result{
        .state = TrackState::kTracking,
        .reference = reference_id_,
        .reference_from_camera = found->reference_from_current,
        .world_from_camera = world_from_reference(map) * found->reference_from_current,
        .inliers = found->correspondences};
    if (!hints.localise_only && keyframe_is_due(*found)) begin_keyframe(result, current, hints);
    return result;
  }

 private:
  TrackResult started(const PreparedSurface& current, TrackHints hints) {
    TrackResult result{.state = TrackState::kTracking};
    begin_keyframe(result, current, hints);
    return result;
  }

  bool keyframe_is_due(const Registration& found) const {
    const Pose& moved = found.reference_from_current;
    return moved.translation().norm() > options_.keyframe_distance ||
           rotation_angle(moved) > options_.keyframe_angle * EIGEN_PI / 180 ||
           found.share < options_.keyframe_share;
  }

  /// What follows is tracked against this frame.
  void begin_keyframe(TrackResult& result, const PreparedSurface& current, TrackHints hints) {
    KeyFrame keyframe{.id = hints.next_keyframe,
                      .frame = current.frame->index,
                      .time = current.frame->time,
                      .world_from_camera = result.world_from_camera};
    keyframe.camera = current.frame->camera;
    keyframe.features = std::make_shared<const Features>();
    result.reference = reference_id_ = keyframe.id;
    result.reference_from_camera = reference_from_last_ = Pose::Identity();
    world_from_new_reference_ = result.world_from_camera;
    reference_ = current.surface;
    result.keyframe = std::move(keyframe);
  }

  /// Its pose in the map or, while it is not there yet, its tracked pose.
  Pose world_from_reference(const SparseMap& map) const {
    return reference_id_ < map.keyframe_id_end() ? map.world_from_keyframe(reference_id_)
                                                 : world_from_new_reference_;
  }

  Options options_;
  std::shared_ptr<const Surface> reference_;  // of the last key frame
  KeyFrameId reference_id_ = kNoId;
  Pose world_from_new_reference_ = Pose::Identity();
  Pose reference_from_last_ = Pose::Identity();
  Pose motion_ = Pose::Identity();  // last_from_current of the previous frame: constant velocity
};

}  // namespace

STILLPOINT_PLUGIN(icp_tracker, "0.1.0",
                  provide<Tracker, IcpTracker>(
                      "icp", "odometry from depth: point-to-plane ICP against the last key frame"));
