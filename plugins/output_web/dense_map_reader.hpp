// The run's dense map, now and then.
#pragma once

#include <algorithm>
#include <chrono>
#include <memory>
#include <stillpoint/sdk.hpp>
#include <utility>

#include "output_web/voxels.hpp"

namespace stillpoint::output_web {

/// Reading it takes milliseconds, for which the dense map waits: at most a twentieth of the time
/// goes into that. On the server's thread.
class DenseMapReader {
 public:
  using Clock = std::chrono::steady_clock;

  void begin(std::shared_ptr<LiveRun> run) { run_ = std::move(run); }
  /// Null when the last time was not long ago, when the map is busy, without one, and when it looks
  /// as it did the last time.
  VoxelsPtr read() {
    const Clock::time_point begin = Clock::now();
    if (!run_ || begin < next_) return nullptr;
    auto points = run_->dense_map();
    if (!points) return nullptr;
    VoxelsPtr voxels = sorted_voxels(*std::move(points));
    const Clock::time_point end = Clock::now();
    next_ = end + std::max<Clock::duration>(std::chrono::seconds(1), 20 * (end - begin));
    if (last_ && look_alike(*last_, *voxels)) return nullptr;
    last_ = voxels;
    return voxels;
  }

 private:
  std::shared_ptr<LiveRun> run_;
  Clock::time_point next_{};
  VoxelsPtr last_;
};

}  // namespace stillpoint::output_web
