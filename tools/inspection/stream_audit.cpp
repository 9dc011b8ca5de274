#include "inspection/stream_audit.hpp"

#include <algorithm>

#include "stillpoint/support/median.hpp"

namespace stillpoint::inspection {

StreamAudit audit_stream(const std::vector<StampedImage>& images) {
  constexpr double kGap = 1.5;  // in median intervals; one missing image makes 2
  StreamAudit audit{.images = images.size()};
  if (images.empty()) return audit;
  audit.begin = images.front().time;
  audit.duration = images.back().time - audit.begin;
  std::vector<double> intervals;
  for (std::size_t i = 1; i < images.size(); ++i)
    intervals.push_back(images[i].time - images[i - 1].time);
  if (intervals.empty()) return audit;
  audit.interval = median(intervals);
  for (std::size_t i = 0; i < intervals.size(); ++i)
    if (intervals[i] > kGap * audit.interval) audit.gaps.push_back({images[i].time, intervals[i]});
  std::stable_sort(audit.gaps.begin(), audit.gaps.end(),
                   [](const Gap& a, const Gap& b) { return a.length > b.length; });
  return audit;
}

}  // namespace stillpoint::inspection
