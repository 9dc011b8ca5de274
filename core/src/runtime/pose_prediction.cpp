#include "stillpoint/runtime/pose_prediction.hpp"

namespace stillpoint {

void PosePrediction::tracked(const std::optional<TrackedFrame>& frame, const SparseMap& map) {
  velocity_.setZero();
  if (last_ && frame && frame->frame->time > last_->frame->time)
    velocity_ = log_se3(frame->pose_in(map).inverse() * last_->pose_in(map)) /
                (frame->frame->time - last_->frame->time);
  last_ = frame;
}

std::vector<Pose> PosePrediction::guesses(double time, const MovingPoints& moving,
                                          const SparseMap& map) const {
  if (!last_) return {};
  const Pose world_from_last = last_->pose_in(map);
  std::vector<Pose> guesses;
  if (moving.camera_motion) guesses.push_back(world_from_last * moving.camera_motion->inverse());
  const Pose motion = exp_se3(velocity_ * (time - last_->frame->time));
  guesses.push_back(world_from_last * motion.inverse());
  guesses.push_back(world_from_last);
  return guesses;
}

}  // namespace stillpoint
