#include "study/slurm_options.hpp"

#include <algorithm>
#include <regex>

namespace stillpoint::study {
namespace {

bool is_time(const std::string& text) {
  static const std::regex kTime(R"((\d+-)?\d+(:\d+){0,2})");
  return text.empty() || std::regex_match(text, kTime);
}

bool is_memory(const std::string& text) {
  static const std::regex kMemory(R"(\d+[KMGT]?)");
  return text.empty() || std::regex_match(text, kMemory);
}

bool is_free_option(const std::string& text) {
  return text.starts_with("--") && !text.starts_with("--array") && !text.starts_with("--output");
}

}  // namespace

void SlurmOptions::visit(OptionVisitor& v) {
  v("partition", partition, {.help = "as in sbatch --partition; empty: the cluster's default"});
  v("account", account, {.help = "as in sbatch --account; empty: the user's default"});
  v("time", time, {.help = "of a run, as in sbatch --time; empty: the partition's default"});
  v("memory", memory, {.help = "of a run, as in sbatch --mem; empty: the partition's default"});
  v("cpus", cpus, {.min = 0, .max = 4096, .help = "of a run; 0: the cluster's default"});
  v("tasks", tasks,
    {.min = 0, .max = 1e6, .help = "runs in the queue at a time; 0: as many as the cluster takes"});
  v("options", options, {.help = "further options of sbatch, as in [--qos=long, --exclusive]"});
  v.require(is_time(time), "'time' is written as sbatch reads it: 90 (minutes), 1:30:00, 2-12");
  v.require(is_memory(memory), "'memory' is written as sbatch reads it: 4G, 500M");
  v.require(std::ranges::all_of(options, is_free_option),
            "'options' are written --NAME or --NAME=VALUE; --array and --output are the study's");
}

std::vector<std::string> sbatch_options(const SlurmOptions& options) {
  std::vector<std::string> result = {"--ntasks=1"};
  const auto add = [&](const char* name, const std::string& value) {
    if (!value.empty()) result.push_back(std::string(name) + "=" + value);
  };
  add("--partition", options.partition);
  add("--account", options.account);
  add("--time", options.time);
  add("--mem", options.memory);
  if (options.cpus > 0) add("--cpus-per-task", std::to_string(options.cpus));
  result.insert(result.end(), options.options.begin(), options.options.end());
  return result;
}

}  // namespace stillpoint::study
