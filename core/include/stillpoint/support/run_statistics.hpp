// Figures of a run, for outputs and for the table at its end.
#pragma once

#include <cstddef>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "stillpoint/contracts/output.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Milliseconds. A percentile is the smallest value that is not exceeded by that share.
struct Distribution {
  double mean = 0.0;
  double p50 = 0.0;
  double p95 = 0.0;
  double p99 = 0.0;
  double max = 0.0;
};
STILLPOINT_EXPORT Distribution distribution_of(std::vector<float> values);

/// Collects stage times; eight bytes each.
class STILLPOINT_EXPORT StageStatistics {
 public:
  struct Row {
    std::string stage;
    std::size_t count = 0;
    Distribution wall;
    Distribution cpu;
  };

  void add(std::span<const StageTime> times);
  /// In the order of the pipeline, stages it does not know last.
  std::vector<Row> rows() const;

 private:
  struct Samples {
    std::vector<float> wall_ms;
    std::vector<float> cpu_ms;
  };
  std::map<std::string, Samples> stages_;
};

struct TrackingStatistics {
  std::size_t frames = 0;  ///< of the recording that were read: processed or dropped
  std::size_t processed = 0;
  std::size_t tracked = 0;
  std::size_t times_lost = 0;          ///< changes to lost
  std::size_t depth_registered = 0;    ///< of those tracked
  std::size_t poorly_constrained = 0;  ///< of those tracked
  double coverage() const {
    return frames == 0 ? 0.0 : static_cast<double>(tracked) / static_cast<double>(frames);
  }
};
STILLPOINT_EXPORT TrackingStatistics tracking_statistics(const RunSummary& summary);

/// Largest resident memory of this process so far, in MiB; 0 when the system does not tell.
STILLPOINT_EXPORT double peak_memory_mib();

}  // namespace stillpoint
