// Transforms between the coordinate frames of tf.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "bag/bag_reader.hpp"
#include "bag/messages.hpp"

namespace stillpoint::bag {

/// The transforms of a bag, from topics such as "/tf_static" and "/tf".
class FrameTree {
 public:
  /// Reads all messages of tf; damaged ones are left out.
  explicit FrameTree(BagReader& bag);

  /// Of two frames that stand still to each other. Throws Error(kUsage) when they move, or when tf
  /// does not connect them.
  Pose target_from_source(const std::string& target, const std::string& source) const;

 private:
  /// To the frame above.
  struct Link {
    std::string parent;
    Pose parent_from_child = Pose::Identity();
    bool moves = false;
  };
  struct Ancestor {
    std::string name;
    Pose ancestor_from_frame = Pose::Identity();
    bool moves = false;  // against the frame
  };

  void add(const TransformMessage& transform);
  std::vector<Ancestor> ancestors_of(const std::string& frame) const;

  std::map<std::string, Link> links_;  // by the child; of several parents, the first
};

}  // namespace stillpoint::bag
