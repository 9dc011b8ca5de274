// What all our problems ask of Ceres.
#pragma once

#include <ceres/iteration_callback.h>
#include <ceres/solver.h>

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

/// Of a sparse problem. `stop` must outlive the solver.
inline ceres::Solver::Options solver_options(ceres::LinearSolverType type, int max_iterations,
                                             StopCallback& stop) {
  ceres::Solver::Options options;
  options.linear_solver_type = type;
  // CHOLMOD, the default, starts threads of its own and rounds as the machine's BLAS does.
  options.sparse_linear_algebra_library_type = ceres::EIGEN_SPARSE;
  options.max_num_iterations = max_iterations;
  options.logging_type = ceres::SILENT;
  options.callbacks = {&stop};
  return options;
}

}  // namespace stillpoint::orb
