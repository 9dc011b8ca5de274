#include "report/run_tables.hpp"

#include <algorithm>
#include <functional>
#include <map>

#include "evaluation/best.hpp"
#include "evaluation/format.hpp"

namespace stillpoint::report {
namespace {

using evaluation::Better;
using evaluation::fixed;
using study::Table;
using study::TableCell;

struct Column {
  const char* title;
  int digits;
  Better better;
  bool is_error;  ///< means little without the coverage
  std::function<std::optional<double>(const RunData&)> figure;
};

std::optional<double> percent(const std::optional<double>& share) {
  return share ? std::optional(100.0 * *share) : std::nullopt;
}

/// A figure of the evaluation, where there is one.
template <class Figure>
auto of_evaluation(Figure figure) {
  return [figure](const RunData& run) -> std::optional<double> {
    return run.evaluation ? figure(*run.evaluation) : std::nullopt;
  };
}

const std::vector<Column>& columns() {
  using Evaluation = evaluation::Evaluation;
  using Figure = std::optional<double>;
  static const std::vector<Column> kColumns = {
      {"ATE RMSE (m)", 4, Better::kSmaller, true,
       of_evaluation([](const Evaluation& e) -> Figure { return e.rigid.metres.rmse; })},
      {"ATE median (m)", 4, Better::kSmaller, true,
       of_evaluation([](const Evaluation& e) -> Figure { return e.rigid.metres.median; })},
      {"ATE max (m)", 4, Better::kSmaller, true,
       of_evaluation([](const Evaluation& e) -> Figure { return e.rigid.metres.max; })},
      {"RPE 1 s (m)", 4, Better::kSmaller, true, of_evaluation([](const Evaluation& e) -> Figure {
         return e.relative ? Figure(e.relative->translation_m.rmse) : std::nullopt;
       })},
      {"RPE 1 s (deg)", 3, Better::kSmaller, true, of_evaluation([](const Evaluation& e) -> Figure {
         return e.relative ? Figure(e.relative->rotation_deg.rmse) : std::nullopt;
       })},
      {"coverage (%)", 1, Better::kLarger, false,
       [](const RunData& run) { return percent(run.coverage); }},
      {"times lost", 0, Better::kSmaller, false, [](const RunData& run) { return run.times_lost; }},
      {"loops closed", 0, Better::kNeither, false,
       [](const RunData& run) { return run.loops_closed; }},
      {"speed (frames/s)", 1, Better::kLarger, false,
       [](const RunData& run) { return run.frames_per_second; }},
      {"CPU (ms/frame)", 1, Better::kSmaller, false,
       [](const RunData& run) { return run.cpu_ms_per_frame; }},
      {"memory (MiB)", 0, Better::kSmaller, false,
       [](const RunData& run) { return run.peak_memory_mib; }}};
  return kColumns;
}

/// In the rows of one recording.
void mark_best(std::span<const RunData> runs, const std::vector<std::size_t>& rows,
               std::size_t place, Table& table) {
  const Column& column = columns()[place - 1];
  const auto times_lost = [&](std::size_t row) { return runs[row].times_lost.value_or(0); };
  const double fewest = times_lost(*std::ranges::min_element(rows, {}, times_lost));
  std::vector<std::optional<evaluation::RatedFigure>> figures;
  for (const std::size_t row : rows) {
    const std::optional<double>& value = table.rows[row][place].value;
    figures.emplace_back();
    if (!value) continue;
    figures.back() = {.value = *value};
    if (!column.is_error) continue;
    figures.back()->coverage_percent = 100.0 * runs[row].coverage.value_or(0);
    figures.back()->can_win = times_lost(row) <= fewest;
  }
  const std::vector<bool> best = best_of(figures, column.better, column.digits);
  for (std::size_t i = 0; i < rows.size(); ++i) table.rows[rows[i]][place].best = best[i];
}

}  // namespace

Table run_table(std::span<const RunData> runs) {
  Table table{.title = "Runs",
              .note = runs.size() > 1
                          ? "Bold: the best of its recording; of errors, among runs "
                            "that cover as much as the one that covers most, up to 1 %, "
                            "and lost tracking as rarely as any."
                          : "",
              .header = {"run"}};
  for (const Column& column : columns()) table.header.emplace_back(column.title);
  std::map<std::string, std::vector<std::size_t>> by_recording;
  for (const RunData& run : runs) {
    by_recording[run.recording].push_back(table.rows.size());
    std::vector<TableCell>& row = table.rows.emplace_back();
    row.push_back({.text = run.name});
    for (const Column& column : columns()) {
      const std::optional<double> value = column.figure(run);
      row.push_back({.text = value ? fixed(*value, column.digits) : "–", .value = value});
    }
  }
  for (const auto& [recording, rows] : by_recording)
    for (std::size_t place = 1; place < table.header.size(); ++place)
      mark_best(runs, rows, place, table);
  return table;
}

}  // namespace stillpoint::report
