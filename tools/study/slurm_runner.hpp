// Runs the cells of a study that have no result yet as job arrays of Slurm.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <stop_token>
#include <string>
#include <vector>

#include "study/cell_runner.hpp"
#include "study/slurm_options.hpp"

namespace stillpoint::study {

struct SlurmStudy {
  std::string name;               ///< of its jobs
  std::filesystem::path folder;   ///< where it keeps what it knows of them
  std::filesystem::path program;  ///< that they run
  std::size_t largest_array = 1;  ///< tasks that Slurm takes in one array
  SlurmOptions options;
};

/// Called by the thread that follows the jobs.
struct SlurmEvents {
  CellFinished finished;
  std::function<void(const std::string& line)> note;  ///< what a user should know
  std::function<void(const std::string& line)>
      status;  ///< how many run and wait; replaces the last
};

/// Fills the empty `results` (parallel to `cells`), first repeats first. Cells that jobs of an
/// earlier call still run are followed, the others submitted. A cell whose job has ended without a
/// result has failed, with the state that Slurm gives. A stop leaves the jobs running; returned are
/// their numbers. Throws Error(kUsage) without Slurm, or when its queue holds cells of the study as
/// it was before it changed; Error(kStage) when Slurm takes no job.
std::vector<std::string> run_missing_with_slurm(const std::vector<PlannedCell>& cells,
                                                const Program& program, const SlurmStudy& study,
                                                const std::stop_token& stop,
                                                const SlurmEvents& events,
                                                std::vector<std::optional<CellResult>>& results);

}  // namespace stillpoint::study
