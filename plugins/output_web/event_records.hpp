// What the event log keeps of frames, calls of stages and loops, and the records of them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stillpoint/sdk.hpp>
#include <string>

#include "output_web/message_writer.hpp"

namespace stillpoint::output_web {

struct FrameEntry {
  TrackedPose pose;
  int features = 0, matches = 0, inliers = 0;
  bool keyframe = false;
  std::optional<Eigen::Vector3d> true_position;
};
struct TimeEntry {
  std::uint32_t frame = 0;
  std::uint8_t stage = 0;  ///< its number
  float wall_ms = 0;
};
struct LoopEntry {
  std::uint32_t frame = 0;
  std::uint32_t moved = 0;    ///< key frames
  float largest_shift_m = 0;  ///< of them
  std::uint32_t count = 1;    ///< loops closed since the frame before
};

/// Names of stages, numbered from `first`.
void write_stages(std::span<const std::string> names, std::size_t first, MessageWriter& writer);
void write_frames(std::span<const FrameEntry> frames, MessageWriter& writer);
/// Images, by the source so far.
void write_left_out(std::size_t images, MessageWriter& writer);
void write_times(std::span<const TimeEntry> times, MessageWriter& writer);
void write_loops(std::span<const LoopEntry> loops, MessageWriter& writer);
/// Of the truth to all frames in the map as it is now; with too few of them, nothing.
void write_fit(std::span<const FrameEntry> frames, const SparseMap& map, MessageWriter& writer);

}  // namespace stillpoint::output_web
