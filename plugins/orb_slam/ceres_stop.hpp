// Ends a Ceres solver when somebody is in a hurry.
#pragma once

#include <ceres/iteration_callback.h>

#include <stop_token>
#include <utility>

namespace stillpoint::orb {

/// Ends with the best result so far, after the current iteration.
class StopCallback final : public ceres::IterationCallback {
 public:
  explicit StopCallback(std::stop_token hurry) : hurry_(std::move(hurry)) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary&) override {
    return hurry_.stop_requested() ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  std::stop_token hurry_;
};

}  // namespace stillpoint::orb
