#include "study/cell_runner.hpp"

#include <algorithm>
#include <chrono>
#include <future>
#include <mutex>
#include <sstream>

#include "stillpoint/error.hpp"
#include "study/cell_folder.hpp"
#include "study/child_process.hpp"
#include "study/console_text.hpp"

namespace stillpoint::study {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kOutOfTime = 124;  // as timeout(1) says it

std::string seconds_text(double seconds) {
  std::ostringstream text;
  text << seconds << " s";
  return text.str();
}

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

std::optional<CellResult> run_cell(const PlannedCell& cell, const Program& program,
                                   const std::stop_token& stop) {
  CellFolder folder(cell.run);
  folder.clear();
  const Clock::time_point start = Clock::now();
  const ProcessEnd end = run_process(cell.command, folder.console(), stop, cell.time_limit);
  CellResult result{.fingerprint = cell.fingerprint,
                    .program = program.fingerprint,
                    .origin = origin_of(program),
                    .exit_code = end.in_time ? end.exit_code : kOutOfTime,
                    .seconds = seconds_since(start)};
  folder.note_written();
  if (end.exit_code != 0 && stop.stop_requested()) return std::nullopt;
  try {
    if (!end.in_time)
      result.message = "took longer than the time limit of " + seconds_text(cell.time_limit);
    else if (end.exit_code == 0)
      result.values = measure_run(cell.run, cell.recording, result.message);
    else
      result.message = failure_text(folder.console(), end);
  } catch (const Error& error) {
    result.exit_code = error.exit_code();
    result.message = error.what();
  }
  write_result(cell.run, result);
  return result;
}

namespace {

/// Hands out cells and takes their results.
class Queue {
 public:
  Queue(std::vector<std::size_t> cells, int jobs) : cells_(std::move(cells)), jobs_(jobs) {}

  std::optional<std::size_t> next() {
    const std::lock_guard lock(mutex_);
    if (next_ == cells_.size()) return std::nullopt;
    return cells_[next_++];
  }

  /// Calls `report` with how far it has come.
  template <class Report>
  void finish(double seconds, Report report) {
    const std::lock_guard lock(mutex_);
    ++done_;
    seconds_ += seconds;
    const double left = static_cast<double>(cells_.size() - done_);
    report({.done = done_,
            .of = cells_.size(),
            .remaining_seconds = left / jobs_ * seconds_ / static_cast<double>(done_)});
  }

 private:
  std::mutex mutex_;
  const std::vector<std::size_t> cells_;
  const int jobs_;
  std::size_t next_ = 0;
  std::size_t done_ = 0;
  double seconds_ = 0.0;  // that cells took, together
};

}  // namespace

std::optional<CellResult> valid_result(const PlannedCell& cell) {
  std::optional<CellResult> result = read_result(cell.run);
  if (result && (result->failed() || result->fingerprint != cell.fingerprint)) result.reset();
  return result;
}

bool has_outdated_result(const PlannedCell& cell) {
  const std::optional<CellResult> result = read_result(cell.run);
  if (!result) return has_foreign_result(cell.run);
  return !result->failed() && result->fingerprint != cell.fingerprint;
}

std::vector<std::size_t> missing_cells(const std::vector<PlannedCell>& cells,
                                       const std::vector<std::optional<CellResult>>& results) {
  std::vector<std::size_t> missing;
  for (std::size_t i = 0; i < cells.size(); ++i)
    if (!results[i]) missing.push_back(i);
  std::ranges::stable_sort(missing, {}, [&](std::size_t i) { return cells[i].cell.repeat; });
  return missing;
}

void run_missing(const std::vector<PlannedCell>& cells, const Program& program, int jobs,
                 const std::stop_token& stop, const CellFinished& finished,
                 std::vector<std::optional<CellResult>>& results) {
  std::vector<std::size_t> missing = missing_cells(cells, results);
  for (const std::size_t i : missing) require_own_folder(cells[i].run);
  const int workers = std::min(jobs, static_cast<int>(missing.size()));
  Queue queue(std::move(missing), jobs);
  const auto work = [&] {
    while (!stop.stop_requested()) {
      const std::optional<std::size_t> i = queue.next();
      if (!i) return;
      std::optional<CellResult> result = run_cell(cells[*i], program, stop);
      if (!result) return;
      queue.finish(result->seconds, [&](const StudyProgress& progress) {
        finished(cells[*i].cell, *result, progress);
        results[*i] = std::move(result);
      });
    }
  };
  std::vector<std::future<void>> running;
  running.reserve(static_cast<std::size_t>(workers));
  for (int i = 0; i < workers; ++i) running.push_back(std::async(std::launch::async, work));
  for (std::future<void>& worker : running) worker.wait();
  for (std::future<void>& worker : running) worker.get();
}

}  // namespace stillpoint::study
