// What the contracts define. The destructors anchor each interface's type information in this
// library, so that every plugin and the program agree on it. Products of poses are not in headers:
// each file that includes them would take half a second longer to compile.
#include "stillpoint/contracts/decision.hpp"
#include "stillpoint/contracts/live_run.hpp"
#include "stillpoint/contracts/local_mapper.hpp"
#include "stillpoint/contracts/loop_closer.hpp"
#include "stillpoint/contracts/map_backend.hpp"
#include "stillpoint/contracts/map_checker.hpp"
#include "stillpoint/contracts/moving_checker.hpp"
#include "stillpoint/contracts/output.hpp"
#include "stillpoint/contracts/propagator.hpp"
#include "stillpoint/contracts/segmenter.hpp"
#include "stillpoint/contracts/source.hpp"
#include "stillpoint/contracts/tracker.hpp"

namespace stillpoint {

Source::~Source() = default;
Segmenter::~Segmenter() = default;
Propagator::~Propagator() = default;
MovingChecker::~MovingChecker() = default;
std::size_t MovingChecker::wanted_keyframes() const { return 0; }
MapChecker::~MapChecker() = default;
Pose TrackedFrame::pose_in(const SparseMap& map) const {
  return reference < map.keyframe_id_end()
             ? map.world_from_keyframe(reference) * reference_from_camera
             : world_from_camera;
}
Decision::~Decision() = default;
PreparedFrame::~PreparedFrame() = default;
Tracker::~Tracker() = default;
LocalMapper::~LocalMapper() = default;
LoopCloser::~LoopCloser() = default;
std::optional<MapCorrection> LoopCloser::adjust(const SparseMap&, std::stop_token) {
  return std::nullopt;
}
MapBackend::~MapBackend() = default;
std::vector<LabelledPoint> MapBackend::occupied() const { return {}; }
LiveRun::~LiveRun() = default;
Output::~Output() = default;

const char* name_of(TrackState state) {
  switch (state) {
    case TrackState::kWaiting:
      return "waiting";
    case TrackState::kTracking:
      return "tracking";
    case TrackState::kLost:
      return "LOST";
  }
  return "";
}

}  // namespace stillpoint
