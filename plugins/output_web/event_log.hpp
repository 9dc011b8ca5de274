// What has happened in the run so far, for viewers that come at any time.
#pragma once

#include <atomic>
#include <cstdint>
#include <deque>
#include <memory>
#include <mutex>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <string>
#include <vector>

#include "output_web/event_records.hpp"
#include "output_web/map_changes.hpp"
#include "output_web/request.hpp"
#include "output_web/truth.hpp"
#include "output_web/voxels.hpp"

namespace stillpoint::output_web {

/// What a viewer has got already.
struct Seen {
  bool run_info = false;
  bool end = false;
  std::size_t stages = 0, frames = 0, times = 0, clouds = 0, loops = 0, steering = 0;
  std::size_t fitted_frames = 0;  ///< that the last fit of the truth was made of
  std::size_t left_out = 0;       ///< images, by the source
  std::optional<std::uint32_t> image;
  SeenMap map;
  VoxelsPtr voxels = std::make_shared<const Voxels>();
};

/// Written by the pipeline's threads, who wait for nothing but a copy of pointers, and read by the
/// server's.
class EventLog {
 public:
  struct Run {
    std::string name;    ///< of the recording
    ClassNames classes;  ///< of the segmenter
    Truth truth;
  };
  explicit EventLog(Run run) : run_(std::move(run)) {}

  void add(const FrameReport& report);
  void finish(const RunSummary& summary);
  /// What Steering::state() is now.
  void set_steering(std::string state);
  void set_voxels(VoxelsPtr voxels);

  /// A message with all that is new to a viewer, as far as it asks for that; empty when nothing is.
  /// Besides the image, it has some of each kind, about half a megabyte in all: who comes late gets
  /// the rest in parts, one with each message.
  std::string news(Seen& seen, const Request& request);

 private:
  bool shows_voxels() const;  // somebody has asked for them
  /// A copy of what is shared, to be written without a lock.
  struct Snapshot;

  void add_times(const std::vector<StageTime>& times);
  void add_loop(const FrameReport& report);
  Snapshot snapshot(Seen& seen, const Request& request) const;
  std::string run_info(const Camera& camera) const;
  const std::string& picture(const FrameReport& report);

  const Run run_;
  mutable std::mutex mutex_;  // of all until picture_
  FrameReport latest_;
  std::vector<FrameEntry> frames_;
  std::vector<std::string> stages_;
  std::deque<TimeEntry> times_;
  std::size_t times_dropped_ = 0;
  std::deque<std::shared_ptr<const std::string>> clouds_;
  std::size_t clouds_dropped_ = 0;
  std::vector<LoopEntry> loops_;
  std::string steering_;
  std::size_t steering_changes_ = 0;
  VoxelsPtr voxels_;  // null: nobody has asked for them
  std::string end_;

  std::optional<std::uint32_t> picture_frame_;  // of the server's thread
  std::string picture_;
};

}  // namespace stillpoint::output_web
