// Job arrays of a study. Each has a numbered folder, which holds its cells, what sbatch answered,
// and what the tasks write before and after their runs.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "study/cell_list.hpp"
#include "study/slurm_options.hpp"

namespace stillpoint::study {

/// Task k of the array runs the cell in line k of its list.
struct SlurmBatch {
  std::filesystem::path folder;
  std::string job;

  std::filesystem::path cells() const;
  std::filesystem::path log(std::size_t task) const;  ///< is there once the task has begun
};

/// Submits them as one array; `program` runs each with its subcommand `run-cell`. `name` is what
/// the queue shows. Throws Error(kStage) with Slurm's answer when it refuses them.
SlurmBatch submit_batch(const std::filesystem::path& folder, const std::string& name,
                        const SlurmOptions& options, const std::filesystem::path& program,
                        const std::vector<ListedCell>& cells);

/// Removes what was written of it into its folder. Files of others stay.
void remove_batch(const SlurmBatch& batch);

/// Of all batches below `folder`, with Slurm's answers there; then `folder` itself, if it is empty.
void remove_batches(const std::filesystem::path& folder);

/// Those below `folder` that Slurm has taken, the oldest first.
std::vector<SlurmBatch> submitted_batches(const std::filesystem::path& folder);

/// Throws Error(kUsage) when jobs of the batches below `folder` are still in the queue, or when
/// that cannot be known: runs on this machine would share their folders.
void refuse_queued_jobs(const std::filesystem::path& folder);

}  // namespace stillpoint::study
