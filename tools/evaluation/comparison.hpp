// Several trajectories against one reference: what `stillpoint compare` prints.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"

namespace stillpoint::evaluation {

/// One of the trajectories.
struct Contestant {
  std::string name;
  Evaluation evaluation;
  AbsoluteError error;  ///< with the alignment of the comparison
};

struct Comparison {
  AlignmentKind alignment = AlignmentKind::kRigid;
  std::vector<Contestant> contestants;
};

/// One line each. A star stands behind the smallest error of a column, among those that cover as
/// much of the reference as the one that covers most, up to 1 %, with at least a quarter as many
/// poses as the one with most: key frames are fewer, and better than the frames between.
std::string comparison_table(const Comparison& comparison);

/// An array of report_json(), with the name, and the errors of the comparison's alignment as
/// "aligned".
nlohmann::ordered_json comparison_json(const Comparison& comparison);

}  // namespace stillpoint::evaluation
