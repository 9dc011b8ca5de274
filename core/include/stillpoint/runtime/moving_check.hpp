// The moving check of each frame against the one before (paper III-C).
#pragma once

#include "stillpoint/runtime/stage.hpp"

namespace stillpoint {

class MovingCheck {
 public:
  MovingCheck(Stage<MovingChecker> checker, TimeLog& times)
      : checker_(std::move(checker), "moving check", times) {}

  bool present() const { return checker_.present(); }
  /// Once per frame, in order. Nothing is known of the first, which has none before it.
  MovingPoints at(const FramePtr& frame);

 private:
  StageCaller<MovingChecker> checker_;
  FramePtr previous_;
};

}  // namespace stillpoint
