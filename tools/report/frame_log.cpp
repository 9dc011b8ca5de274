#include "report/frame_log.hpp"

#include <algorithm>
#include <map>

#include "report/csv_reader.hpp"

namespace stillpoint::report {
namespace {

/// The calls of a stage, before those for one frame are added up.
struct Calls {
  std::size_t count = 0;
  std::map<std::uint32_t, std::pair<float, float>> by_frame;  // wall, CPU
};

StageTimes times_of(const StageStatistics::Row& row, const Calls& calls) {
  StageTimes times{.stage = row.stage, .calls = calls.count, .wall = row.wall, .cpu = row.cpu};
  for (const auto& [frame, ms] : calls.by_frame) {
    times.frame.push_back(frame);
    times.wall_ms.push_back(ms.first);
    times.cpu_ms.push_back(ms.second);
  }
  return times;
}

}  // namespace

std::vector<FrameRow> read_frames(const std::filesystem::path& file) {
  std::vector<FrameRow> rows;
  if (!std::filesystem::exists(file)) return rows;
  CsvReader csv(file, "frame,time,state,features,matches,inliers,moving_points,excluded_percent");
  while (csv.next()) {
    FrameRow row{.frame = csv.number<std::uint32_t>(0),
                 .time = csv.number<double>(1),
                 .tracked = csv.text(2) == "tracking",
                 .features = csv.number<int>(3),
                 .matches = csv.number<int>(4),
                 .inliers = csv.number<int>(5)};
    if (!csv.text(6).empty()) row.moving_points = csv.number<int>(6);
    row.excluded = csv.number<double>(7) / 100.0;
    rows.push_back(row);
  }
  return rows;
}

std::vector<StageTimes> read_stage_times(const std::filesystem::path& file) {
  std::vector<StageTimes> result;
  if (!std::filesystem::exists(file)) return result;
  std::map<std::string, Calls> stages;
  std::vector<StageTime> all;
  CsvReader csv(file, "frame,stage,wall_ms,cpu_ms");
  while (csv.next()) {
    const auto frame = csv.number<std::uint32_t>(0);
    const auto wall = csv.number<float>(2), cpu = csv.number<float>(3);
    all.push_back({std::string(csv.text(1)), wall, cpu, frame});
    Calls& calls = stages[all.back().stage];
    ++calls.count;
    auto& [wall_sum, cpu_sum] = calls.by_frame[frame];
    wall_sum += wall;
    cpu_sum += cpu;
  }
  StageStatistics statistics;
  statistics.add(all);
  for (const StageStatistics::Row& row : statistics.rows())
    result.push_back(times_of(row, stages[row.stage]));
  return result;
}

}  // namespace stillpoint::report
