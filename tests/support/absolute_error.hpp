#pragma once

#include <filesystem>

#include "evaluation/evaluation.hpp"

namespace stillpoint::testing {

/// RMSE of the absolute trajectory error after SE(3) alignment, in metres.
inline double absolute_error(const std::filesystem::path& recording,
                             const std::filesystem::path& trajectory) {
  return evaluation::evaluate(evaluation::read_trajectory(recording / "groundtruth.txt"),
                              evaluation::read_trajectory(trajectory), {}, {})
      .rigid.metres.rmse;
}

}  // namespace stillpoint::testing
