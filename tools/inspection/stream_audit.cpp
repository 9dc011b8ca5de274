#include "inspection/stream_audit.hpp"

#include <algorithm>

#include "stillpoint/support/median.hpp"

namespace stillpoint::inspection {

StreamAudit audit_stream(const std::vector<double>& times) {
  constexpr double kGap = 1.5;  // in median intervals; one missing image makes 2
  StreamAudit audit{.images = times.size()};
  if (times.empty()) return audit;
  audit.begin = times.front();
  audit.duration = times.back() - audit.begin;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < times.size(); ++i) intervals.push_back(times[i] - times[i - 1]);
  if (intervals.empty()) return audit;
  audit.interval = median(intervals);
  for (std::size_t i = 0; i < intervals.size(); ++i)
    if (intervals[i] > kGap * audit.interval) audit.gaps.push_back({times[i], intervals[i]});
  std::stable_sort(audit.gaps.begin(), audit.gaps.end(),
                   [](const Gap& a, const Gap& b) { return a.length > b.length; });
  return audit;
}

}  // namespace stillpoint::inspection
