#include "inspection/truth_audit.hpp"

#include <algorithm>

namespace stillpoint::inspection {
namespace {

using tum_recording::ListLine;
using tum_recording::parse_number;
using tum_recording::read_list_lines;

constexpr double kNear = 0.02;  // seconds, as in the benchmark's scripts

/// Time, position and quaternion, all finite.
bool is_pose(const ListLine& line) {
  return line.columns.size() >= 8 &&
         std::all_of(line.columns.begin(), line.columns.begin() + 8,
                     [](const std::string& text) { return parse_number(text).has_value(); });
}

bool is_near(const std::vector<double>& times, double time) {
  const auto after = std::lower_bound(times.begin(), times.end(), time);
  return (after != times.end() && *after - time <= kNear) ||
         (after != times.begin() && time - *(after - 1) <= kNear);
}

}  // namespace

TruthAudit audit_truth(const std::filesystem::path& file, const std::vector<ImagePair>& pairs) {
  TruthAudit audit;
  std::vector<double> times;
  for (const ListLine& line : read_list_lines(file)) {
    if (is_pose(line)) {
      times.push_back(*parse_number(line.columns[0]));
    } else if (audit.unusable_lines++ == 0) {
      audit.first_unusable = file.string() + ":" + std::to_string(line.number);
    }
  }
  audit.poses = times.size();
  if (times.empty()) return audit;
  std::sort(times.begin(), times.end());
  audit.begin = times.front();
  audit.end = times.back();
  const auto covered = std::count_if(pairs.begin(), pairs.end(), [&](const ImagePair& pair) {
    return is_near(times, pair.color.time);
  });
  if (!pairs.empty())
    audit.covered = static_cast<double>(covered) / static_cast<double>(pairs.size());
  return audit;
}

}  // namespace stillpoint::inspection
