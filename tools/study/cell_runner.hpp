// Runs the cells of a study that have no result yet, several at a time.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "study/cell_result.hpp"
#include "study/matrix.hpp"

namespace stillpoint::study {

struct PlannedCell {
  Cell cell;
  std::vector<std::string> command;  ///< program and arguments; writes into `run`
  std::filesystem::path run;         ///< folder of its own
  std::filesystem::path recording;   ///< with groundtruth.txt
  std::string fingerprint;           ///< of what the result depends on
  double time_limit = 0.0;           ///< seconds; 0: none
};

struct StudyProgress {
  std::size_t done = 0;  ///< this one included
  std::size_t of = 0;    ///< cells to run in this call
  double remaining_seconds = 0.0;
};

/// Called after each cell, by one thread at a time.
using CellFinished =
    std::function<void(const Cell& cell, const CellResult& result, const StudyProgress& progress)>;

/// The result that a cell already has: nothing when it failed or was made from something else.
std::optional<CellResult> valid_result(const PlannedCell& cell);

/// Whether there is the good result of another pipeline, recording or seed, or of a version with
/// other results: running the cell replaces it.
bool has_outdated_result(const PlannedCell& cell);

/// The cells without a result, first repeats first: a study that is stopped half-way has something
/// to say about everything.
std::vector<std::size_t> missing_cells(const std::vector<PlannedCell>& cells,
                                       const std::vector<std::optional<CellResult>>& results);

/// Runs it, and keeps the result beside the run. Nothing when it was stopped. Files that others
/// have put into its folder stay; throws Error(kUsage) where no study has run in it.
std::optional<CellResult> run_cell(const PlannedCell& cell, const Program& program,
                                   const std::stop_token& stop);

/// Fills the empty `results` (parallel to `cells`), first repeats first, `jobs` processes at most
/// at a time, and keeps each result beside its run. After a stop they stay empty. A run that fails
/// is a result. `program` is the one that the commands run. Throws as run_cell does, before any
/// runs.
void run_missing(const std::vector<PlannedCell>& cells, const Program& program, int jobs,
                 const std::stop_token& stop, const CellFinished& finished,
                 std::vector<std::optional<CellResult>>& results);

}  // namespace stillpoint::study
