#include "study/markdown_report.hpp"

#include <vector>

#include "study/markdown_table.hpp"
#include "study/provenance.hpp"
#include "study/study_tables.hpp"

namespace stillpoint::study {
namespace {

std::string section(const Table& table) {
  std::vector<std::vector<std::string>> rows;
  for (const std::vector<TableCell>& cells : table.rows) {
    std::vector<std::string>& row = rows.emplace_back();
    for (const TableCell& cell : cells) row.push_back(cell.text);
  }
  std::string text = "\n## " + table.title + "\n\n";
  if (!rows.empty()) text += markdown_table(table.header, rows);
  if (!table.note.empty()) text += (rows.empty() ? "" : "\n") + table.note + "\n";
  return text;
}

/// The command that repeats the runs; which builds made them, where and when.
std::string origins(const StudyResults& results) {
  std::string text = results.command.empty() ? "" : "\n`" + results.command + "`\n";
  const std::vector<std::string> lines = provenance(results);
  for (const std::string& line : lines) text += (lines.size() > 1 ? "\n* " : "\n") + line;
  return lines.empty() ? text : text + "\n";
}

std::string introduction(const StudyResults& results) {
  const Study& study = results.study;
  const int last = study.seed + study.repeats - 1;
  std::string text = study.repeats == 1
                         ? "One run of each, seed " + std::to_string(study.seed) + "."
                         : "Median (smallest–largest) of " + std::to_string(study.repeats) +
                               " runs, seeds " + std::to_string(study.seed) + " to " +
                               std::to_string(last) + ".";
  text += " Coverage is given after an error where it is below 100 %.\n";
  if (results.missing() > 0)
    text += "\n**Not finished:** " + std::to_string(results.missing()) + " of " +
            std::to_string(results.cells.size()) + " runs are missing.\n";
  return text + origins(results);
}

/// Runs that say something: they failed, or cannot be compared with the truth.
std::string remarks(const StudyResults& results) {
  std::string text;
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    const std::optional<CellResult>& result = results.results[i];
    if (!result || result->message.empty()) continue;
    text += "* " + name_of(results.study, results.cells[i]) + ": " +
            (result->failed() ? "exit code " + std::to_string(result->exit_code) + ": " : "") +
            result->message + "\n";
  }
  return text.empty() ? "" : "\n## Runs that failed or cannot be compared\n\n" + text;
}

}  // namespace

std::string markdown_report(const StudyResults& results, const std::string& title) {
  std::string text = "# " + title + "\n\n";
  if (!results.study.question.empty()) text += results.study.question + "\n\n";
  text += introduction(results);
  for (const Table& table : study_tables(results)) text += section(table);
  return text + remarks(results);
}

}  // namespace stillpoint::study
