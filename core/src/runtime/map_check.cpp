#include "stillpoint/runtime/map_check.hpp"

#include <utility>

#include "stillpoint/runtime/perception_results.hpp"
#include "stillpoint/runtime/thorough_checks.hpp"

namespace stillpoint {
namespace {

MapEvidence compare(MapChecker& checker, const Frame& frame, std::span<const Pose> guesses,
                    const SparseMap& map, bool thorough) {
  MapEvidence found = checker.check(frame, guesses, map);
  check_evidence(found, frame.gray.size());
  if (thorough) check_thoroughly(found);
  return found;
}

}  // namespace

MapEvidence MapCheck::check(const Frame& frame, const MovingPoints& moving, const SparseMap& map) {
  if (!checker_.present()) return {};
  // Here, not in clear() and tracked(): that would be on the thread of tracking.
  if (std::exchange(to_clear_, false)) checker_.call("map_check", frame.index, &MapChecker::clear);
  if (const auto tracked = std::exchange(to_remember_, std::nullopt))
    checker_.call("map_check", frame.index, &MapChecker::remember, *tracked);
  const std::vector<Pose> guesses = prediction_.guesses(frame.time, moving, map);
  if (guesses.empty()) return {};
  return checker_.call("map_check", frame.index, compare, frame, guesses, map, thorough_);
}

void MapCheck::clear() {
  to_clear_ = true;
  to_remember_.reset();
  prediction_ = {};
}

void MapCheck::tracked(const std::optional<TrackedFrame>& frame, const SparseMap& map) {
  if (!checker_.present()) return;
  to_remember_ = frame;
  prediction_.tracked(to_remember_, map);
}

}  // namespace stillpoint
