// Transforms between the coordinate frames of tf in the last seconds.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "bag/messages.hpp"
#include "stillpoint/pose_math.hpp"

namespace stillpoint::ros2 {

/// What tf says, as tf2's buffer keeps it.
class FrameBuffer {
 public:
  enum class Topic { kTf, kTfStatic };

  void add(const bag::TransformMessage& transform, Topic topic);

  /// At `time` (seconds), between the two transforms around it, or as known last. Nothing when tf
  /// does not connect the frames, or knows nothing of that time.
  std::optional<Pose> target_from_source(const std::string& target, const std::string& source,
                                         std::optional<double> time) const;

 private:
  /// To the frame above.
  struct Link {
    std::string parent;
    bool moves = false;
    std::deque<StampedPose> poses;  // parent_from_child, by rising time; not empty
  };
  struct Ancestor {
    std::string name;
    Pose ancestor_from_frame = Pose::Identity();
  };

  static std::optional<Pose> pose_at(const Link& link, std::optional<double> time);
  std::vector<Ancestor> ancestors_of(const std::string& frame, std::optional<double> time) const;

  std::map<std::string, Link> links_;  // by the child
};

}  // namespace stillpoint::ros2
