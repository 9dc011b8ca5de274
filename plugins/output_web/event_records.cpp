#include "output_web/event_records.hpp"

#include <algorithm>
#include <limits>
#include <stillpoint/support/trajectory.hpp>
#include <vector>

#include "output_web/truth.hpp"

namespace stillpoint::output_web {
namespace {

std::uint16_t short_of(int value) {
  return static_cast<std::uint16_t>(
      std::clamp(value, 0, int{std::numeric_limits<std::uint16_t>::max()}));
}

}  // namespace

void write_stages(std::span<const std::string> names, std::size_t first, MessageWriter& writer) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    writer.begin(Record::kStages);
    writer.number(static_cast<std::uint8_t>(first + i));
    writer.text(names[i]);
    writer.end();
  }
}

void write_frames(std::span<const FrameEntry> frames, MessageWriter& writer) {
  if (frames.empty()) return;
  writer.begin(Record::kFrames);
  for (const FrameEntry& frame : frames) {
    const int flags = (frame.keyframe ? 1 : 0) | (frame.pose.depth_registered ? 2 : 0) |
                      (frame.pose.poorly_constrained ? 4 : 0) | (frame.true_position ? 8 : 0);
    writer.number(frame.pose.frame);
    writer.number(frame.pose.time);
    writer.number(static_cast<std::uint8_t>(frame.pose.state));
    writer.number(static_cast<std::uint8_t>(flags));
    writer.number(frame.pose.reference);
    writer.pose(frame.pose.reference_from_camera);
    writer.pose(frame.pose.world_from_camera);
    for (const int count : {frame.features, frame.matches, frame.inliers})
      writer.number(short_of(count));
    writer.point(frame.true_position.value_or(Eigen::Vector3d::Zero()));
  }
  writer.end();
}

void write_left_out(std::size_t images, MessageWriter& writer) {
  writer.begin(Record::kLeftOut);
  writer.number(static_cast<std::uint32_t>(images));
  writer.end();
}

void write_times(std::span<const TimeEntry> times, MessageWriter& writer) {
  if (times.empty()) return;
  writer.begin(Record::kTimes);
  for (const TimeEntry& time : times) {
    writer.number(time.frame);
    writer.number(time.stage);
    writer.number(time.wall_ms);
  }
  writer.end();
}

void write_loops(std::span<const LoopEntry> loops, MessageWriter& writer) {
  for (const LoopEntry& loop : loops) {
    writer.begin(Record::kLoops);
    writer.number(loop.frame);
    writer.number(loop.moved);
    writer.number(loop.largest_shift_m);
    writer.number(loop.count);
    writer.end();
  }
}

void write_fit(std::span<const FrameEntry> frames, const SparseMap& map, MessageWriter& writer) {
  std::vector<Eigen::Vector3d> truth, estimate;
  for (const FrameEntry& frame : frames) {
    if (!frame.true_position) continue;
    const auto world = world_from_camera(map, frame.pose);
    if (!world) continue;
    truth.push_back(*frame.true_position);
    estimate.emplace_back(world->translation());
  }
  const auto fitted = fit_truth(truth, estimate);
  if (!fitted) return;
  writer.begin(Record::kTruth);
  writer.pose(fitted->world_from_truth);
  writer.number(static_cast<float>(fitted->rmse_m));
  writer.number(static_cast<std::uint32_t>(fitted->pairs));
  writer.end();
}

}  // namespace stillpoint::output_web
