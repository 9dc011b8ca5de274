#include "study/slurm_batch.hpp"

#include <algorithm>
#include <charconv>
#include <map>
#include <optional>
#include <set>

#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "study/slurm_queue.hpp"
#include "study/text_file.hpp"

namespace stillpoint::study {
namespace {

constexpr const char* kAnswer = "sbatch.txt";
constexpr const char* kCells = "cells.jsonl";
constexpr const char* kScriptFile = "job.sh";
constexpr const char* kQueueAnswer = "squeue.txt";

// sbatch keeps a copy of the script; its arguments need no quoting.
constexpr const char* kScript =
    "#!/bin/sh\n"
    "exec \"$1\" run-cell \"$2\" \"$SLURM_ARRAY_TASK_ID\"\n";

std::optional<int> number_in(const std::string& name) {
  int number = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), number);
  if (error != std::errc{} || end != name.data() + name.size()) return std::nullopt;
  return number;
}

std::map<int, std::filesystem::path> numbered_folders(const std::filesystem::path& folder) {
  std::map<int, std::filesystem::path> folders;
  std::error_code ignored;  // no such folder: no batches
  for (const auto& entry : std::filesystem::directory_iterator(folder, ignored))
    if (const auto number = number_in(entry.path().filename().string()))
      folders.emplace(*number, entry.path());
  return folders;
}

/// sbatch puts other things in the place of %a, %j, ….
std::string without_patterns(const std::string& path) {
  std::string text;
  for (const char c : path) text += c == '%' ? std::string("%%") : std::string(1, c);
  return text;
}

/// "17.txt", what a task has written.
bool is_log(const std::filesystem::path& file) {
  return file.extension() == ".txt" && number_in(file.stem().string());
}

void remove_if_empty(const std::filesystem::path& folder) {
  std::error_code is_not_empty;
  std::filesystem::remove(folder, is_not_empty);
}

}  // namespace

std::filesystem::path SlurmBatch::cells() const { return folder / kCells; }

std::filesystem::path SlurmBatch::log(std::size_t task) const {
  return folder / (std::to_string(task) + ".txt");
}

SlurmBatch submit_batch(const std::filesystem::path& folder, const std::string& name,
                        const SlurmOptions& options, const std::filesystem::path& program,
                        const std::vector<ListedCell>& cells) {
  const auto earlier = numbered_folders(folder);
  const int number = earlier.empty() ? 1 : earlier.rbegin()->first + 1;
  SlurmBatch batch{.folder = folder / std::to_string(number), .job = {}};
  const std::filesystem::path script = batch.folder / kScriptFile;
  write_cells(batch.cells(), cells);
  write_text(script, kScript);
  std::vector<std::string> arguments = sbatch_options(options);
  arguments.insert(arguments.end(),
                   {"--job-name=" + name, "--array=0-" + std::to_string(cells.size() - 1),
                    "--output=" + without_patterns(batch.folder.string()) + "/%a.txt",
                    script.string(), program.string(), batch.cells().string()});
  try {
    batch.job = submit_job(std::move(arguments), batch.folder / kAnswer);
  } catch (const Error&) {
    remove_batch(batch);
    throw;
  }
  return batch;
}

// The list of cells goes last: it says whose folder this is.
void remove_batch(const SlurmBatch& batch) {
  std::error_code none;
  if (!std::filesystem::exists(batch.cells(), none)) return;
  std::vector<std::filesystem::path> logs;
  for (const auto& entry : std::filesystem::directory_iterator(batch.folder, none))
    if (is_log(entry.path())) logs.push_back(entry.path());
  for (const std::filesystem::path& log : logs) remove_folder(log);
  for (const char* name : {kAnswer, kScriptFile, kCells}) remove_folder(batch.folder / name);
  remove_if_empty(batch.folder);
}

void remove_batches(const std::filesystem::path& folder) {
  for (const auto& [number, path] : numbered_folders(folder))
    remove_batch({.folder = path, .job = {}});
  for (const char* answer : {kQueueAnswer, "scontrol.txt"}) remove_folder(folder / answer);
  remove_if_empty(folder);
}

std::vector<SlurmBatch> submitted_batches(const std::filesystem::path& folder) {
  std::vector<SlurmBatch> batches;
  for (const auto& [number, path] : numbered_folders(folder))
    if (const auto job = submitted_job(path / kAnswer))
      batches.push_back({.folder = path, .job = *job});
  return batches;
}

void refuse_queued_jobs(const std::filesystem::path& folder) {
  std::vector<std::string> jobs;
  for (const SlurmBatch& batch : submitted_batches(folder)) jobs.push_back(batch.job);
  if (jobs.empty()) return;
  std::set<std::string> queued;
  try {
    for (const auto& [task, state] : tasks_of(jobs, folder / kQueueAnswer))
      if (!state.is_over()) queued.insert(task.job);
  } catch (const Error& error) {
    throw Error(Fault::kUsage,
                "runs of this study were given to Slurm, which does not say whether they go on (" +
                    std::string(error.what()) + ")",
                folder.string(), "remove this folder when you know that they do not");
  }
  if (queued.empty()) return;
  const std::vector<std::string> ids(queued.begin(), queued.end());
  throw Error(
      Fault::kUsage, "runs of this study are in Slurm's queue: job " + join(ids), {},
      "follow them with --executor slurm, or cancel them with 'scancel " + join(ids, " ") + "'");
}

}  // namespace stillpoint::study
