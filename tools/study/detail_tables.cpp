#include "study/detail_tables.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "study/table_cells.hpp"

namespace stillpoint::study {
namespace {

/// Of all errors, in the order of the columns.
std::vector<MetricId> statistics_columns() {
  std::vector<MetricId> columns;
  for (const ErrorFigures& figures : error_figures())
    for (const MetricId metric : figures.all()) columns.push_back(metric);
  return columns;
}

/// Adds a row, unless it is one without figures.
void add_row(std::vector<TableCell> row, Table& table) {
  if (std::any_of(row.begin() + static_cast<std::ptrdiff_t>(table.names), row.end(),
                  [](const TableCell& cell) { return cell.value.has_value(); }))
    table.rows.push_back(std::move(row));
}

/// The systems that have a row.
std::vector<const Published*> published_in(const Study& study, const Table& table) {
  std::vector<const Published*> systems;
  for (const Published& system : study.published)
    if (std::ranges::any_of(table.rows, [&](const std::vector<TableCell>& row) {
          return row[1].text == published_name(system);
        }))
      systems.push_back(&system);
  return systems;
}

void add_error_rows(const StudyResults& results, std::size_t sequence, Table& table) {
  const Study& study = results.study;
  const std::string& name = study.sequences[sequence].name;
  const std::vector<MetricId> columns = statistics_columns();
  std::vector<std::vector<bool>> best;
  for (const MetricId metric : columns) best.push_back(best_variants(results, sequence, metric));
  for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
    std::vector<TableCell> row = {{.text = name}, {.text = study.variants[variant].name}};
    for (std::size_t i = 0; i < columns.size(); ++i) {
      const auto spread = results.spread(sequence, variant, columns[i]);
      row.push_back(spread ? number_cell(spread->median, metrics()[columns[i]].digits)
                           : TableCell{.text = kNothing});
      row.back().best = best[i][variant];
    }
    TableCell& rmse = row[table.names];
    const auto spread = results.spread(sequence, variant, kAte);
    const bool failed = !spread && results.all_failed(sequence, variant);
    if (spread)
      rmse.text += coverage_note(results, sequence, variant) + count_note(*spread, study.repeats);
    else if (failed)
      rmse.text = "failed";
    if (spread || failed) table.rows.push_back(std::move(row));
  }
  if (table.rows.empty() || table.rows.back().front().text != name) return;  // nothing is measured
  for (const Published& system : study.published) {
    std::vector<TableCell> row = {{.text = name}, {.text = published_name(system)}};
    for (const MetricId metric : columns)
      row.push_back(published_cell(system, original_of(study.sequences[sequence]), metric));
    add_row(std::move(row), table);
  }
}

}  // namespace

Table stage_table(const StudyResults& results) {
  const Study& study = results.study;
  const auto systems = published_with_stages_of(results);
  Table table{.title = "Time of each stage, mean of its calls (ms)",
              .note = "Wall clock; median (smallest–largest) of all runs, all sequences together.",
              .header = {"stage"}};
  for (const Variant& variant : study.variants) table.header.push_back(variant.name);
  for (const Published* system : systems) table.header.push_back(published_name(*system));
  for (std::size_t i = kFirstStage; i < kMetricCount; ++i) {
    const auto metric = static_cast<MetricId>(i);
    const Metric& m = metrics()[metric];
    if (!results.spread(metric)) continue;
    std::vector<TableCell> row = {{.text = std::string(m.title) + " (" + m.brief + ")"}};
    for (std::size_t variant = 0; variant < study.variants.size(); ++variant)
      row.push_back(spread_cell(results.spread(variant, metric), m.digits));
    for (const Published* system : systems) row.push_back(published_cell(*system, "", metric));
    table.rows.push_back(std::move(row));
  }
  if (table.rows.empty()) return {};
  if (!systems.empty()) table.note += " " + published_note(systems);
  return table;
}

Table error_statistics_table(const StudyResults& results) {
  if (!results.spread(kAteMean)) return {};
  Table table{.title = "RMSE, mean, median and standard deviation of the errors",
              .header = {"sequence", "variant"}};
  table.names = 2;
  for (const ErrorFigures& figures : error_figures()) {
    const std::string brief = figures.brief;
    table.header.push_back(brief + ", RMSE (" + metrics()[figures.rmse].unit + ")");
    for (const MetricId metric : {figures.mean, figures.median, figures.sd})
      table.header.push_back(brief + ", " + metrics()[metric].brief);
  }
  for (std::size_t sequence = 0; sequence < results.study.sequences.size(); ++sequence)
    add_error_rows(results, sequence, table);
  table.note = published_note(published_in(results.study, table));
  return table;
}

}  // namespace stillpoint::study
