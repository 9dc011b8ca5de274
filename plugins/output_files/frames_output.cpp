#include "output_files/frames_output.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "output_files/excluded.hpp"

namespace stillpoint::output_files {
namespace {

/// Empty where the moving check was inconclusive.
std::string moving_text(const MovingPoints& moving) {
  if (!moving.reliable) return "";
  return std::to_string(std::ranges::count_if(moving.points, &PointMotion::moving));
}

}  // namespace

FramesOutput::FramesOutput(const Options& options, const StageContext& context)
    : file_(context.output_directory / options.file) {
  file_.stream() << "frame,time,state,features,matches,inliers,moving_points,excluded_percent\n";
}

void FramesOutput::frame(const FrameReport& report) {
  const TrackResult& result = report.result;
  std::array<char, 160> line{};
  std::snprintf(line.data(), line.size(), "%u,%.6f,%s,%d,%d,%d,%s,%.2f\n", report.frame->index,
                report.frame->time, name_of(result.state), result.features, result.matches,
                result.inliers, moving_text(report.moving).c_str(),
                100.0 * excluded_share(report.weights.get()));
  file_.stream() << line.data();
}

}  // namespace stillpoint::output_files
