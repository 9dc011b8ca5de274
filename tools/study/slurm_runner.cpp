#include "study/slurm_runner.hpp"

#include <algorithm>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <mutex>
#include <set>
#include <unordered_map>

#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "study/cell_folder.hpp"
#include "study/console_text.hpp"
#include "study/slurm_batch.hpp"
#include "study/slurm_queue.hpp"
#include "study/text_file.hpp"

namespace stillpoint::study {
namespace {

using SlurmClock = std::chrono::steady_clock;

// Between two calls of squeue, which loads the cluster:
constexpr double kPollShare = 0.01;      // of the time that the study has taken so far …
constexpr double kMinPollSeconds = 1.0;  // … within these limits
constexpr double kMaxPollSeconds = 30.0;
constexpr double kLateFiles = 60.0;  // seconds: network file systems show new files this late
constexpr int kFailed = 1;
constexpr int kTooLong = 124;  // as timeout(1) says it

double seconds_from(SlurmClock::time_point start) {
  return std::chrono::duration<double>(SlurmClock::now() - start).count();
}

class SlurmRunner {
 public:
  SlurmRunner(const std::vector<PlannedCell>& cells, const Program& program,
              const SlurmStudy& study, const std::stop_token& stop, const SlurmEvents& events,
              std::vector<std::optional<CellResult>>& results)
      : cells_(cells),
        program_(program),
        study_(study),
        stop_(stop),
        events_(events),
        results_(results) {}

  std::vector<std::string> run() {
    const std::vector<std::size_t> missing = missing_cells(cells_, results_);
    for (const std::size_t i : missing) require_own_folder(cells_[i].run);
    total_ = missing.size();
    waiting_.assign(missing.begin(), missing.end());
    follow_earlier_jobs();
    while (!stop_.stop_requested()) {
      submit();
      if (queued_.empty()) break;
      wait();
      look();
    }
    events_.status("");
    if (queued_.empty()) remove_batches(study_.folder);
    return jobs();
  }

 private:
  struct Queued {
    std::size_t cell = 0;                          // index into cells_
    std::filesystem::path log;                     // of its task
    std::optional<SlurmClock::time_point> missed;  // since when its result should be there
  };

  std::filesystem::path scratch() const { return study_.folder / "squeue.txt"; }

  std::string share(std::size_t count) const {
    return std::to_string(count) + " of " + std::to_string(total_) + " runs";
  }

  std::vector<std::string> jobs() const {
    std::set<std::string> ids;
    for (const auto& [task, queued] : queued_) ids.insert(task.job);
    return {ids.begin(), ids.end()};
  }

  /// Takes over what earlier calls have submitted and is not over.
  void follow_earlier_jobs() {
    const std::vector<SlurmBatch> batches = submitted_batches(study_.folder);
    std::vector<std::string> ids;
    for (const SlurmBatch& batch : batches) ids.push_back(batch.job);
    const auto states = tasks_of(ids, scratch());
    std::set<std::string> of_another_study;
    for (const SlurmBatch& batch : batches)
      if (!follow(batch, states, of_another_study)) remove_batch(batch);
    refuse(of_another_study);
    std::set<std::size_t> followed;
    for (const auto& [task, queued] : queued_) followed.insert(queued.cell);
    std::erase_if(waiting_, [&](std::size_t i) { return followed.contains(i); });
    if (!followed.empty())
      events_.note("in the queue already: " + share(followed.size()) + ", job " + join(jobs()));
  }

  /// False when all its tasks are over.
  bool follow(const SlurmBatch& batch, const std::map<SlurmTask, SlurmState>& states,
              std::set<std::string>& of_another_study) {
    const auto is_queued = [&](const auto& entry) {
      return entry.first.job == batch.job && !entry.second.is_over();
    };
    if (std::ranges::none_of(states, is_queued)) return false;
    const std::vector<ListedCell> listed = read_cells(batch.cells());
    for (const auto& entry : states) {
      const SlurmTask& task = entry.first;
      if (!is_queued(entry) || task.number >= listed.size()) continue;
      const PlannedCell& cell = listed[task.number].cell;
      const auto planned = index_of_run(cell.run);
      if (!planned) continue;
      if (cells_[*planned].fingerprint != cell.fingerprint)
        of_another_study.insert(task.job);
      else if (!results_[*planned])
        queued_[task] = {.cell = *planned, .log = batch.log(task.number), .missed = {}};
    }
    return true;
  }

  std::optional<std::size_t> index_of_run(const std::filesystem::path& run) {
    if (index_.empty())
      for (std::size_t i = 0; i < cells_.size(); ++i) index_[cells_[i].run.string()] = i;
    const auto found = index_.find(run.string());
    return found == index_.end() ? std::nullopt : std::optional(found->second);
  }

  static void refuse(const std::set<std::string>& of_another_study) {
    if (of_another_study.empty()) return;
    const std::vector<std::string> ids(of_another_study.begin(), of_another_study.end());
    throw Error(
        Fault::kUsage,
        "Slurm's queue holds runs of this study as it was before it changed: job " + join(ids), {},
        "cancel them with 'scancel " + join(ids, " ") + "', or wait for their end");
  }

  std::size_t room() const { return limit_ > queued_.size() ? limit_ - queued_.size() : 0; }

  /// As much as the queue takes, once half of it is free: in few arrays.
  void submit() {
    if (room() < std::min(waiting_.size(), limit_ / 2 + 1)) return;
    while (!waiting_.empty() && room() > 0 && !stop_.stop_requested()) {
      try {
        submit_first(std::min({room(), study_.largest_array, waiting_.size()}));
      } catch (const Error& error) {
        if (queued_.empty()) throw;
        limit_ = queued_.size();  // which it has taken
        events_.note("Slurm takes no more for now, " + std::to_string(waiting_.size()) +
                     " runs are submitted later: " + error.what());
      }
    }
  }

  void submit_first(std::size_t count) {
    std::vector<ListedCell> listed;
    for (std::size_t k = 0; k < count; ++k) {
      const PlannedCell& cell = cells_[waiting_[k]];
      CellFolder(cell.run).forget_result();  // what is there from now on is the job's
      listed.push_back({.cell = cell, .program = program_.fingerprint});
    }
    const SlurmBatch batch =
        submit_batch(study_.folder, study_.name, study_.options, study_.program, listed);
    for (std::size_t k = 0; k < count; ++k) {
      queued_[{.job = batch.job, .number = k}] = {
          .cell = waiting_.front(), .log = batch.log(k), .missed = {}};
      waiting_.pop_front();
    }
    events_.note("submitted as job " + batch.job + ": " + share(count));
  }

  void wait() {
    const double seconds =
        std::clamp(kPollShare * seconds_from(start_), kMinPollSeconds, kMaxPollSeconds);
    std::mutex mutex;
    std::unique_lock lock(mutex);
    std::condition_variable_any().wait_for(lock, stop_, std::chrono::duration<double>(seconds),
                                           [] { return false; });
  }

  /// Takes the results of the tasks that are over.
  void look() {
    std::map<SlurmTask, SlurmState> states;
    try {
      states = tasks_of(jobs(), scratch());
      silent_ = false;
    } catch (const Error& error) {  // its controller may be restarted: the jobs go on
      if (!silent_) events_.note(std::string(error.what()) + "; asking again");
      silent_ = true;
      return;
    }
    std::size_t waiting = 0;
    std::string reason;
    for (auto task = queued_.begin(); task != queued_.end();) {
      const auto found = states.find(task->first);
      const SlurmState state = found == states.end() ? SlurmState{} : found->second;
      if (state.is_waiting()) {
        ++waiting;
        reason = state.reason;
      }
      const bool queued = !state.name.empty() && !state.is_over();
      task = !queued && is_finished(task->second, state) ? queued_.erase(task) : std::next(task);
    }
    events_.status(std::to_string(queued_.size() - waiting) + " running, " +
                   std::to_string(waiting + waiting_.size()) + " waiting" +
                   (reason.empty() ? "" : " (" + reason + ")"));
  }

  /// Of a task that is over. False: its result may still appear.
  bool is_finished(Queued& queued, const SlurmState& state) {
    const PlannedCell& cell = cells_[queued.cell];
    std::optional<CellResult> result = read_result(cell.run);
    if (!result || result->fingerprint != cell.fingerprint) {
      if (!queued.missed) queued.missed = SlurmClock::now();
      const bool has_ended_well = state.name.empty() || state.name == "COMPLETED";
      if (has_ended_well && seconds_from(*queued.missed) < kLateFiles) return false;
      result = without_result(cell, queued.log, state);
      write_result(cell.run, *result);
    } else if (add_reason(*result, state)) {
      write_result(cell.run, *result);
    }
    ++done_;
    const double left = static_cast<double>(total_ - done_);
    events_.finished(
        cell.cell, *result,
        {.done = done_,
         .of = total_,
         .remaining_seconds = left * seconds_from(start_) / static_cast<double>(done_)});
    results_[queued.cell] = std::move(result);
    return true;
  }

  /// Where Slurm has ended the run and not its job: what exceeds the memory is the largest process.
  static bool add_reason(CellResult& result, const SlurmState& state) {
    const bool is_known = state.name.empty() || state.name == "COMPLETED" || state.name == "FAILED";
    if (!result.failed() || is_known) return false;
    result.message += "; Slurm says " + state.name;
    return true;
  }

  /// The log of its task moves into the folder of the run.
  CellResult without_result(const PlannedCell& cell, const std::filesystem::path& log,
                            const SlurmState& state) const {
    CellResult result{.fingerprint = cell.fingerprint,
                      .program = program_.fingerprint,
                      .origin = origin_of(program_),
                      .exit_code = state.name == "TIMEOUT" ? kTooLong : kFailed,
                      .message = "left no result; Slurm " +
                                 (state.name.empty() ? std::string("has forgotten its job")
                                                     : "says " + state.name)};
    std::error_code error;
    if (!std::filesystem::exists(log, error)) return result;  // it never began
    make_folder(cell.run);
    const std::filesystem::path kept = job_log_of(cell.run);
    std::filesystem::rename(log, kept, error);
    if (!error && !std::filesystem::is_empty(kept, error))
      result.message += ": " + failure_text(kept, {});
    return result;
  }

  const std::vector<PlannedCell>& cells_;
  const Program& program_;
  const SlurmStudy& study_;
  const std::stop_token& stop_;
  const SlurmEvents& events_;
  std::vector<std::optional<CellResult>>& results_;

  const SlurmClock::time_point start_ = SlurmClock::now();
  std::unordered_map<std::string, std::size_t> index_;  // of cells_, by folder
  std::deque<std::size_t> waiting_;                     // to be submitted
  std::map<SlurmTask, Queued> queued_;                  // submitted, without a result
  std::size_t limit_ = study_.options.tasks > 0 ? static_cast<std::size_t>(study_.options.tasks)
                                                : cells_.size();  // of queued_
  std::size_t total_ = 0;
  std::size_t done_ = 0;
  bool silent_ = false;  // squeue does not answer
};

}  // namespace

std::vector<std::string> run_missing_with_slurm(const std::vector<PlannedCell>& cells,
                                                const Program& program, const SlurmStudy& study,
                                                const std::stop_token& stop,
                                                const SlurmEvents& events,
                                                std::vector<std::optional<CellResult>>& results) {
  return SlurmRunner(cells, program, study, stop, events, results).run();
}

}  // namespace stillpoint::study
