// Stages that look at images: source, segmenter, propagator, checks and decision.
#include <memory>
#include <opencv2/core.hpp>
#include <stop_token>

#include "plugin_check/frame_drive.hpp"
#include "plugin_check/map_making.hpp"
#include "stillpoint/runtime/perception_results.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint::plugin_check {
namespace {

constexpr std::uint32_t kMaxSourceFrames = 30;

// The scenario only says that it is a source's turn: sources bring frames of their own.
class SourceDrive final : public Drive {
 public:
  SourceDrive(Source& stage, Observer& observer) : stage_(stage), observer_(observer) {}

  bool step() override {
    if (!begun_) {
      begun_ = true;
      observer_.call("begin", {}, [&] { stage_.begin(stop_.get_token()); });
      return true;
    }
    if (next_ == kMaxSourceFrames) return false;
    auto frame = observer_.call("next", next_, [&] { return stage_.next(); });
    if (!frame) return false;
    observer_.check("next", next_, [&] {
      check_frame(*frame, next_, previous_ ? &*previous_ : nullptr);
      check_thoroughly(*frame);
    });
    observer_.saw(frame->time);
    for (const cv::Mat& image : {frame->bgr, frame->gray, frame->depth}) observer_.saw(image);
    observer_.call("left_out", next_, [&] { return stage_.left_out(); });
    previous_ = std::move(frame);
    ++next_;
    return true;
  }

  void finish() override {
    const auto size = observer_.call("size", {}, [&] { return stage_.size(); });
    if (size && next_ < kMaxSourceFrames && *size < next_)
      throw Failure({"size() said " + std::to_string(*size) + " frames, but next() gave " +
                         std::to_string(next_),
                     "progress would go beyond 100 %",
                     "give the number of frames that can be expected, or nothing"});
    observer_.call("report", {}, [&] { return stage_.report(); });
    observer_.call("ground_truth", {}, [&] { return stage_.ground_truth(); });
    if (next_ == 0)
      throw Failure({"it gave no frame", "a run without frames has no result",
                     "throw Error(Fault::kData) in the constructor when there is nothing to read"});
    if (next_ == kMaxSourceFrames) return;
    if (observer_.call("next", next_, [&] { return stage_.next(); }))
      throw Failure({"next() gave a frame after the end",
                     "the runtime takes an empty result for the end",
                     "give nothing in every call after the last frame"});
  }

  std::string remark() const override { return std::to_string(next_) + " frames"; }

 private:
  Source& stage_;
  Observer& observer_;
  std::stop_source stop_;  // never requested
  bool begun_ = false;
  std::uint32_t next_ = 0;
  std::optional<Frame> previous_;
};

void saw(Observer& observer, const Segmentation& segmentation) {
  observer.saw(segmentation.labels);
  observer.saw(segmentation.instances);
  for (const SegmentedObject& object : segmentation.objects) {
    observer.saw(object.id);
    observer.saw(object.label);
    observer.saw(object.pixels);
    observer.saw(object.score);
  }
}

void require_unchanged(const std::string& function, const cv::Mat& labels, std::uint32_t before) {
  if (checksum_of(labels) != before)
    throw Failure({function + "() wrote to the labels", "other threads read them",
                   "clone() what is to be changed"});
}

class SegmenterDrive final : public FrameDrive<Segmenter> {
 public:
  using FrameDrive::FrameDrive;

 private:
  void at(std::size_t i) override {
    const ClassNames classes = call("classes", i, [&] { return stage_.classes(); });
    if (classes.size() < 2 || classes.size() > 256)
      throw Failure({"classes() gives " + std::to_string(classes.size()) + " names",
                     "labels are 8-bit, and label 0 is the background",
                     "give 2 to 256 names, that of the background first"});
    const Segmentation result = call("segment", i, [&] { return stage_.segment(*input(i).frame); });
    check("segment", i, [&] { check_segmentation(result, *input(i).frame, classes.size()); });
    saw(observer_, result);
    labelled_ += result.known() && cv::countNonZero(result.labels) > 0;
    ++frames_;
  }

 public:
  std::string remark() const override {
    return "labels in " + std::to_string(labelled_) + " of " + std::to_string(frames_) + " frames";
  }

 private:
  int labelled_ = 0, frames_ = 0;
};

class PropagatorDrive final : public FrameDrive<Propagator> {
 public:
  using FrameDrive::FrameDrive;

 private:
  // Labels of every third frame arrive, one frame late, as those of a network do.
  void at(std::size_t i) override {
    constexpr std::size_t kInterval = 3;
    const std::size_t from = i / kInterval * kInterval - (i % kInterval == 0 && i > 0 ? 1 : 0);
    const Input& labelled = input(from);
    const std::uint32_t before = checksum_of(labelled.segmentation->labels);
    const Segmentation result = call("propagate", i, [&] {
      return stage_.propagate(*labelled.segmentation, *labelled.frame, *input(i).frame);
    });
    check("propagate", i, [&] {
      check_segmentation(result, *input(i).frame, testing::TestRecording::classes().size());
    });
    require_unchanged("propagate", labelled.segmentation->labels, before);
    saw(observer_, result);
  }
};

class MovingCheckerDrive final : public FrameDrive<MovingChecker> {
 public:
  using FrameDrive::FrameDrive;
  std::string remark() const override { return std::to_string(points_) + " points"; }

 private:
  void at(std::size_t i) override {
    if (i == 0) {
      check("wanted_keyframes", i, [&] { wanted_ = stage_.wanted_keyframes(); });
      return;
    }
    const MovingPoints result = call(
        "check", i, [&] { return stage_.check(*input(i - 1).frame, *input(i).frame, history(i)); });
    check("check", i, [&] {
      check_moving_points(result, input(i).frame->gray.size());
      check_thoroughly(result);
    });
    observer_.saw(result.reliable);
    for (const PointMotion& point : result.points) {
      for (const float value :
           {point.previous.x, point.previous.y, point.current.x, point.current.y, point.residual})
        observer_.saw(value);
      observer_.saw(point.moving);
    }
    if (result.camera_motion) observer_.saw(*result.camera_motion);
    points_ += result.points.size();
  }

  // Every second frame became a key frame; every fourth was not tracked.
  TrackingHistory history(std::size_t i) const {
    TrackingHistory history;
    if (i % 4 != 0) history.world_from_previous = input(i - 1).world_from_camera;
    for (std::size_t k = (i - 1) / 2 * 2 + 2; k >= 2 && history.keyframes.size() < wanted_; k -= 2)
      history.keyframes.push_back(scenario_.dense_keyframe(
          k - 2, scenario_.first_keyframe + static_cast<KeyFrameId>(k / 2 - 1)));
    return history;
  }

  std::size_t wanted_ = 0, points_ = 0;
};

class MapCheckerDrive final : public FrameDrive<MapChecker> {
 public:
  using FrameDrive::FrameDrive;

 private:
  // The second frame in five is lost, and has several poses that it may have.
  void at(std::size_t i) override {
    const Input& now = input(i);
    std::vector<Pose> guesses = {now.world_from_camera};
    if (i % 5 == 1) guesses.insert(guesses.begin(), Pose::Identity());
    const MapEvidence result =
        call("check", i, [&] { return stage_.check(*now.frame, guesses, map_); });
    check("check", i, [&] {
      check_evidence(result, now.frame->gray.size());
      check_thoroughly(result);
    });
    observer_.saw(result.log_odds);
    if (i % 5 == 1) return;
    TrackedFrame tracked{.frame = now.frame,
                         .weights = now.weights,
                         .reference = scenario_.first_keyframe,
                         .reference_from_camera = now.world_from_camera,
                         .world_from_camera = now.world_from_camera};
    call("remember", i, [&] { stage_.remember(tracked); });
    if (i % 10 == 9) call("clear", i, [&] { stage_.clear(); });
    if (map_.empty())
      map_ = inserted(saved_map(scenario_), scenario_.keyframe(i, scenario_.first_keyframe));
  }

  SparseMap map_;
};

class DecisionDrive final : public FrameDrive<Decision> {
 public:
  using FrameDrive::FrameDrive;

 private:
  void at(std::size_t i) override {
    const Input& now = input(i);
    const std::uint32_t before = checksum_of(now.segmentation->labels);
    const StaticWeights result = call("decide", i, [&] {
      return stage_.decide(*now.frame, *now.segmentation, now.moving, now.evidence);
    });
    check("decide", i, [&] { check_weights(result, *now.segmentation, now.frame->gray.size()); });
    require_unchanged("decide", now.segmentation->labels, before);
    observer_.saw(result.track);
    observer_.saw(result.map);
  }
};

}  // namespace

template <>
std::unique_ptr<Drive> make_drive(Source& stage, const DriveSetup& setup) {
  return std::make_unique<SourceDrive>(stage, setup.observer);
}
template <>
std::unique_ptr<Drive> make_drive(Segmenter& stage, const DriveSetup& setup) {
  return std::make_unique<SegmenterDrive>(stage, setup);
}
template <>
std::unique_ptr<Drive> make_drive(Propagator& stage, const DriveSetup& setup) {
  return std::make_unique<PropagatorDrive>(stage, setup);
}
template <>
std::unique_ptr<Drive> make_drive(MovingChecker& stage, const DriveSetup& setup) {
  return std::make_unique<MovingCheckerDrive>(stage, setup);
}
template <>
std::unique_ptr<Drive> make_drive(MapChecker& stage, const DriveSetup& setup) {
  return std::make_unique<MapCheckerDrive>(stage, setup);
}
template <>
std::unique_ptr<Drive> make_drive(Decision& stage, const DriveSetup& setup) {
  return std::make_unique<DecisionDrive>(stage, setup);
}

}  // namespace stillpoint::plugin_check
