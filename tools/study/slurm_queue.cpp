#include "study/slurm_queue.hpp"

#include <algorithm>
#include <array>
#include <regex>
#include <sstream>

#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "study/child_process.hpp"
#include "study/text_file.hpp"

namespace stillpoint::study {
namespace {

constexpr int kNoSuchCommand = 127;  // as env(1) says it

/// "sbatch: error: no such partition" and more of these as one line, without the command's name.
std::string complaint(const std::string& command, const std::string& answer) {
  std::istringstream lines(answer);
  std::vector<std::string> complaints;
  for (std::string line; std::getline(lines, line);) {
    const std::string prefix = command + ": error: ";
    complaints.push_back(line.starts_with(prefix) ? line.substr(prefix.size()) : line);
  }
  return complaints.empty() ? "gave no answer" : join(complaints, "; ");
}

/// Its exit code; what it writes goes to `answer`.
int call(std::vector<std::string> command, const std::filesystem::path& answer) {
  const std::string name = command.front();
  command.insert(command.begin(), "/usr/bin/env");
  // Never stopped half-way: a job that was submitted and not noted would run unknown.
  const ProcessEnd end = run_process(std::move(command), answer, {});
  if (end.exit_code == kNoSuchCommand)
    throw Error(Fault::kUsage, "there is no command '" + name + "' of Slurm on this machine", {},
                "run it where you submit jobs to the cluster, or use --executor local");
  return end.exit_code;
}

[[noreturn]] void fail(const char* command, const std::filesystem::path& answer,
                       const char* remedy = "") {
  throw Error(Fault::kStage, complaint(command, read_text(answer)), command, remedy);
}

/// "12|3|RUNNING|None"; nothing of a job that is no array.
std::optional<std::pair<SlurmTask, SlurmState>> parse_task(const std::string& line) {
  static const std::regex kTask(R"((\d+)\|(\d+)\|([A-Z_]+)\|(.*))");
  std::smatch part;
  if (!std::regex_match(line, part, kTask)) return std::nullopt;
  return std::pair{SlurmTask{.job = part[1], .number = std::stoul(part[2])},
                   SlurmState{.name = part[3], .reason = part[4]}};
}

}  // namespace

bool SlurmState::is_over() const {
  constexpr std::array kOver = {"BOOT_FAIL", "CANCELLED",     "COMPLETED", "DEADLINE", "FAILED",
                                "NODE_FAIL", "OUT_OF_MEMORY", "PREEMPTED", "TIMEOUT"};
  return std::ranges::find(kOver, name) != kOver.end();
}

std::string submit_job(std::vector<std::string> arguments, const std::filesystem::path& answer) {
  arguments.insert(arguments.begin(), {"sbatch", "--parsable"});
  const int exit_code = call(std::move(arguments), answer);
  const std::optional<std::string> job = submitted_job(answer);
  if (exit_code != 0 || !job)
    fail("sbatch", answer, "'slurm' of the study says what its jobs ask for");
  return *job;
}

std::optional<std::string> submitted_job(const std::filesystem::path& answer) {
  static const std::regex kJob(R"((\d+)(;.*)?)");  // with the cluster's name where there are many
  std::istringstream lines(read_text(answer));     // among them may be warnings
  for (std::string line; std::getline(lines, line);)
    if (std::smatch part; std::regex_match(line, part, kJob)) return part[1];
  return std::nullopt;
}

std::map<SlurmTask, SlurmState> tasks_of(const std::vector<std::string>& jobs,
                                         const std::filesystem::path& scratch) {
  std::map<SlurmTask, SlurmState> tasks;
  if (jobs.empty()) return tasks;
  const int exit_code = call({"squeue", "--noheader", "--array", "--states=all",
                              "--jobs=" + join(jobs, ","), "--format=%F|%K|%T|%r"},
                             scratch);
  const std::string answer = read_text(scratch);
  if (answer.find("Invalid job id") != std::string::npos)
    return tasks;  // the only one is forgotten
  if (exit_code != 0) fail("squeue", scratch);
  std::istringstream lines(answer);
  for (std::string line; std::getline(lines, line);)
    if (auto task = parse_task(line)) tasks.insert(*std::move(task));
  return tasks;
}

std::size_t largest_array(const std::filesystem::path& scratch) {
  if (call({"scontrol", "show", "config"}, scratch) != 0) fail("scontrol", scratch);
  static const std::regex kSize(R"(MaxArraySize\s*=\s*(\d+))");
  const std::string answer = read_text(scratch);
  std::smatch part;
  if (!std::regex_search(answer, part, kSize)) return 1;
  return std::max<std::size_t>(1, std::stoul(part[1]));
}

}  // namespace stillpoint::study
