// The transforms of a robot, from /tf and /tf_static.
#pragma once

#include <chrono>
#include <optional>
#include <string>

#include "ros2/frame_buffer.hpp"
#include "ros2/participant.hpp"

namespace stillpoint::ros2 {

/// Used by one thread at a time.
class TransformListener {
 public:
  /// Throws as Reader.
  explicit TransformListener(const Participant& participant);

  /// As FrameBuffer has it; what is not known yet is waited for.
  std::optional<Pose> target_from_source(const std::string& target, const std::string& source,
                                         std::optional<double> time,
                                         std::chrono::milliseconds patience);

 private:
  /// What has come since; without any, the next of /tf until `deadline`. Whether there was one.
  bool read(std::chrono::steady_clock::time_point deadline);

  Reader tf_, tf_static_;
  FrameBuffer frames_;
};

}  // namespace stillpoint::ros2
