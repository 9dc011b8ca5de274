// Slurm's commands: a job array goes into the queue, and is looked for there.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace stillpoint::study {

/// A task of a job array: number of the array's job, and its own.
struct SlurmTask {
  std::string job;
  std::size_t number = 0;

  auto operator<=>(const SlurmTask&) const = default;
};

struct SlurmState {
  std::string name;    ///< as squeue prints it: "RUNNING", "TIMEOUT"
  std::string reason;  ///< that it waits: "Resources"

  bool is_over() const;  ///< it will not run (again)
  bool is_waiting() const { return name == "PENDING"; }
};

/// Hands `arguments` to sbatch, which writes the number of the job into `answer`, so that it is
/// known even if this program ends at that moment. Throws Error(kStage) with what sbatch said.
std::string submit_job(std::vector<std::string> arguments, const std::filesystem::path& answer);

/// What sbatch wrote there; nothing when it submitted no job.
std::optional<std::string> submitted_job(const std::filesystem::path& answer);

/// The tasks that Slurm still knows of these jobs: all that are not over, and those that were over
/// in the last minutes. `scratch` is a file for its answer. Throws Error(kStage) when it gives
/// none.
std::map<SlurmTask, SlurmState> tasks_of(const std::vector<std::string>& jobs,
                                         const std::filesystem::path& scratch);

/// Tasks that a job array may have. Throws Error(kStage) when Slurm does not answer.
std::size_t largest_array(const std::filesystem::path& scratch);

}  // namespace stillpoint::study
