// Loop closers: key frames of a recording without loops, and a place that is seen again.
#include <algorithm>
#include <cmath>
#include <memory>
#include <stop_token>

#include "plugin_check/frame_drive.hpp"
#include "plugin_check/map_making.hpp"
#include "plugin_check/round_trip.hpp"
#include "stillpoint/runtime/mapping_results.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint::plugin_check {
namespace {

std::string millimetres(double metres) {
  return std::to_string(std::lround(1000 * metres)) + " mm";
}

/// Asks for loops, and applies what comes.
class LoopsOf {
 public:
  LoopsOf(LoopCloser& stage, Observer& observer) : stage_(stage), observer_(observer) {}

  /// The map without the loops that its newest key frame closes.
  SparseMap close(SparseMap map, std::uint32_t frame, const std::stop_token& stop) {
    const auto newest = static_cast<KeyFrameId>(map.keyframe_id_end() - 1);
    const auto correction =
        observer_.call("close", frame, [&] { return stage_.close(map, newest, stop); });
    if (!correction) return map;
    ++closed_;
    map = corrected("close", frame, *correction, std::move(map));
    const auto adjusted = observer_.call("adjust", frame, [&] { return stage_.adjust(map, stop); });
    return adjusted ? corrected("adjust", frame, *adjusted, std::move(map)) : map;
  }
  int closed() const { return closed_; }

 private:
  SparseMap corrected(const char* function, std::uint32_t frame, const MapCorrection& correction,
                      SparseMap map) {
    observer_.check(function, frame, [&] { check_correction(correction, map); });
    map = apply(correction, std::move(map));
    observer_.check(function, frame, [&] { check_thoroughly(map); });
    saw(observer_, map);
    return map;
  }

  LoopCloser& stage_;
  Observer& observer_;
  int closed_ = 0;
};

class LoopCloserDrive final : public FrameDrive<LoopCloser> {
 public:
  using FrameDrive::FrameDrive;

  std::string remark() const override { return std::to_string(loops_.closed()) + " loops closed"; }

 private:
  void at(std::size_t i) override {
    if (i % kFramesPerKeyFrame != 0) return;
    const auto id = static_cast<KeyFrameId>(map_.keyframe_id_end());
    map_ = inserted(std::move(map_), scenario_.keyframe(i, id));
    map_ = loops_.close(std::move(map_), input(i).frame->index,
                        i % 2 == 0 ? std::stop_token() : requested_stop());
  }

  LoopsOf loops_{stage_, observer_};
  SparseMap map_ = saved_map(scenario_);
};

class RoundTripDrive final : public Drive {
 public:
  RoundTripDrive(LoopCloser& stage, Observer& observer) : loops_(stage, observer) {}

  bool step() override {
    if (trip_.is_over()) return false;
    map_ = trip_.with_next(std::move(map_));
    const int closed_before = loops_.closed();
    const double before = trip_.error(map_);
    map_ = loops_.close(std::move(map_), trip_.newest(), {});
    if (loops_.closed() > closed_before) require_nearer(before);
    worst_metres_ = std::max(worst_metres_, before);
    return true;
  }

  std::string remark() const override {
    if (loops_.closed() == 0) return "no loop closed";
    return std::to_string(loops_.closed()) + " closed, " + millimetres(worst_metres_) +
           " of drift before, " + millimetres(trip_.error(map_)) + " at the end";
  }

  std::optional<Finding> unchecked() const override {
    if (loops_.closed() > 0) return std::nullopt;
    return Finding{"it closed no loop, although the camera came back to where it had begun, " +
                       std::to_string(RoundTrip::kPerTurn) + " key frames later and " +
                       millimetres(worst_metres_) + " off",
                   "a loop closer that never closes one does nothing, and nothing of what it gives "
                   "has been checked",
                   "it is right for one that needs longer loops or other features than ORB: "
                   "options that let it close this one are given with --set"};
  }

 private:
  // A loop corrects the newest key frame to where its place is.
  void require_nearer(double before) const {
    constexpr double kNoise = 0.05;  // metres
    const double after = trip_.error(map_);
    if (after <= before + kNoise) return;
    throw Failure({"its correction moved key frame " + std::to_string(trip_.newest()) +
                       " away from where it is: it was off by " + millimetres(before) +
                       ", and is by " + millimetres(after),
                   "a wrong loop ruins the map",
                   "verify what looks alike by the geometry of its points, and close no loop when "
                   "in doubt; are the new poses world_from_camera, and not the other way round?"});
  }

  LoopsOf loops_;
  RoundTrip trip_;
  SparseMap map_;
  double worst_metres_ = 0;
};

}  // namespace

template <>
std::unique_ptr<Drive> make_drive(LoopCloser& stage, const DriveSetup& setup) {
  if (setup.scenario.is_round_trip) return std::make_unique<RoundTripDrive>(stage, setup.observer);
  return std::make_unique<LoopCloserDrive>(stage, setup);
}

}  // namespace stillpoint::plugin_check
