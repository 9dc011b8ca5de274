#include "report/report_tables.hpp"

#include <algorithm>
#include <string>

#include "study/study_tables.hpp"

namespace stillpoint::report {
namespace {

using study::Table;
using study::TableCell;

bool has_marked(const Table& table, bool TableCell::*mark) {
  return std::ranges::any_of(table.rows, [&](const std::vector<TableCell>& row) {
    return std::ranges::any_of(row, mark);
  });
}

/// What results.md says above all tables, and what is bold.
std::string note_of_figures(const study::Study& study) {
  return (study.repeats > 1
              ? "Median (smallest–largest) of " + std::to_string(study.repeats) + " runs."
              : std::string("One run of each.")) +
         " Bold: the best" + study::among_comparable();
}

}  // namespace

std::vector<Table> report_tables(const study::StudyResults& results) {
  std::vector<Table> tables = study::study_tables(results);
  std::erase_if(tables, [](const Table& table) { return table.rows.empty(); });
  for (Table& table : tables) {
    if (has_marked(table, &TableCell::best))
      table.note = note_of_figures(results.study) + (table.note.empty() ? "" : " " + table.note);
    if (has_marked(table, &TableCell::significant)) table.note += " †: corrected p below 0.05.";
  }
  return tables;
}

}  // namespace stillpoint::report
