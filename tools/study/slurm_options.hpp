// What the jobs of a study ask of Slurm.
#pragma once

#include <string>
#include <vector>

#include "stillpoint/options.hpp"

namespace stillpoint::study {

/// For each run, which is one task of a job array. What is empty or 0 is left to the cluster.
struct SlurmOptions {
  std::string partition;
  std::string account;
  std::string time;    ///< as sbatch --time reads it: "90" (minutes), "1:30:00", "2-12"
  std::string memory;  ///< as sbatch --mem reads it: "4G", "500" (MiB)
  int cpus = 0;
  int tasks = 0;                     ///< in the queue at a time
  std::vector<std::string> options;  ///< further ones of sbatch, "--qos=long"

  void visit(OptionVisitor& visitor);
};

/// The same as options of sbatch.
std::vector<std::string> sbatch_options(const SlurmOptions& options);

}  // namespace stillpoint::study
