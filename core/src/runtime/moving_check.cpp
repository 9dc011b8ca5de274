#include "stillpoint/runtime/moving_check.hpp"

#include <utility>

#include "stillpoint/runtime/stage_results.hpp"

namespace stillpoint {
namespace {

MovingPoints check_motion(MovingChecker& checker, const Frame& previous, const Frame& frame) {
  MovingPoints found = checker.check(previous, frame);
  check_moving_points(found);
  return found;
}

}  // namespace

MovingPoints MovingCheck::at(const FramePtr& frame) {
  const FramePtr previous = std::exchange(previous_, frame);
  if (!previous) return {};
  return checker_.call("moving_check", frame->index, check_motion, *previous, *frame);
}

}  // namespace stillpoint
