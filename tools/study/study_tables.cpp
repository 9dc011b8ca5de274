#include "study/study_tables.hpp"

#include <algorithm>
#include <functional>
#include <string>
#include <utility>

#include "stillpoint/support/did_you_mean.hpp"
#include "study/comparison_table.hpp"
#include "study/detail_tables.hpp"
#include "study/table_cells.hpp"

namespace stillpoint::study {
namespace {

using CellOf = std::function<TableCell(std::size_t sequence, std::size_t variant)>;

std::string title_of(const Metric& metric) {
  return metric.title + (*metric.unit ? " (" + std::string(metric.unit) + ")" : "");
}

/// Sequences × variants.
Table matrix(const Study& study, std::string title, const CellOf& cell_of) {
  Table table{.title = std::move(title), .header = {"sequence"}};
  for (const Variant& variant : study.variants) table.header.push_back(variant.name);
  for (std::size_t sequence = 0; sequence < study.sequences.size(); ++sequence) {
    table.rows.push_back({{.text = study.sequences[sequence].name}});
    for (std::size_t variant = 0; variant < study.variants.size(); ++variant)
      table.rows.back().push_back(cell_of(sequence, variant));
  }
  return table;
}

/// Leaves out sequences of which there is nothing.
Table without_empty_rows(Table table) {
  std::erase_if(table.rows, [](const std::vector<TableCell>& row) {
    return std::all_of(row.begin() + 1, row.end(),
                       [](const TableCell& cell) { return cell.text == kNothing; });
  });
  return table;
}

void mark_best(const StudyResults& results, MetricId metric, Table& table) {
  for (std::size_t sequence = 0; sequence < table.rows.size(); ++sequence) {
    const std::vector<bool> best = best_variants(results, sequence, metric);
    for (std::size_t variant = 0; variant < best.size(); ++variant)
      table.rows[sequence][variant + 1].best = best[variant];
  }
}

/// The recording that the sequence of a row is, or is the twin of.
std::string original_of_row(const Study& study, const std::vector<TableCell>& row) {
  return original_of(*std::ranges::find(study.sequences, row.front().text, &Sequence::name));
}

/// Of those with a figure in one of the rows.
void add_published(const Study& study, MetricId metric, Table& table) {
  std::vector<const Published*> systems = published_with(study, metric, metric + 1);
  std::erase_if(systems, [&](const Published* system) {
    return std::ranges::none_of(table.rows, [&](const std::vector<TableCell>& row) {
      return system->find(original_of_row(study, row), metric).has_value();
    });
  });
  for (const Published* system : systems) table.header.push_back(published_name(*system));
  for (std::vector<TableCell>& row : table.rows) {
    const std::string original = original_of_row(study, row);
    for (const Published* system : systems)
      row.push_back(published_cell(*system, original, metric));
  }
  table.note = published_note(systems);
}

Table metric_table(const StudyResults& results, MetricId metric) {
  const Metric& m = metrics()[metric];
  const std::optional<Spread> all = results.spread(metric);
  if (!all) return {};
  if (all->min == 0.0 && all->max == 0.0) return {.title = title_of(m), .note = "0 in every run."};
  Table table = matrix(results.study, title_of(m), [&](std::size_t sequence, std::size_t variant) {
    return metric_cell(results, sequence, variant, metric);
  });
  mark_best(results, metric, table);
  table = without_empty_rows(std::move(table));
  add_published(results.study, metric, table);
  return table;
}

void mark_significant(const Study& study, const std::vector<PairedComparison>& comparisons,
                      Table& table) {
  for (const PairedComparison& one : comparisons)
    if (one.is_significant()) table.header[one.variant + 1] += " †";
  const std::string note = significance_note(study, comparisons);
  if (!note.empty()) table.note += (table.note.empty() ? "" : " ") + note;
}

Table improvement_table(const StudyResults& results) {
  const auto baseline = baseline_of(results.study);
  const auto improvement = [&](std::size_t sequence, std::size_t variant) {
    const auto percent = improvement_percent(results, sequence, variant);
    TableCell cell = spread_cell(percent, 1);
    if (!percent) return cell;
    cell.text += coverage_note(results, sequence, variant);
    const std::string covered = partial_coverage(results, sequence, *baseline, "–");
    if (!covered.empty()) cell.text += ", baseline " + covered + " %";
    cell.text += count_note(*percent, results.study.repeats);
    return cell;
  };
  const std::string title = "Improvement of the ATE over " + results.study.baseline + " (%)";
  Table table = without_empty_rows(matrix(results.study, title, improvement));
  table.note = "1 − ATE ÷ ATE of " + results.study.baseline + ", run by run with the same seed" +
               (results.study.repeats > 1 ? ": median (smallest–largest)." : ".");
  return table.rows.empty() ? Table() : table;
}

Table penalty_table(const StudyResults& results) {
  const auto penalty = [&](std::size_t sequence, std::size_t variant) {
    const auto value = dynamic_penalty(results, sequence, variant);
    if (!value) return TableCell{.text = kNothing};
    TableCell cell = number_cell(*value, 2);
    cell.text += coverage_note(results, sequence, variant);
    const std::size_t empty = *empty_scene_of(results.study, sequence);
    const std::string covered = partial_coverage(results, empty, variant, "–");
    if (!covered.empty()) cell.text += ", empty scene " + covered + " %";
    const Spread with_motion = *results.spread(sequence, variant, kAte);
    const Spread without = *results.spread(empty, variant, kAte);
    cell.text += count_note(without.count < with_motion.count ? without : with_motion,
                            results.study.repeats);
    return cell;
  };
  return without_empty_rows(
      matrix(results.study,
             "Dynamic penalty: ATE ÷ ATE along the same camera path in the empty scene", penalty));
}

/// Of a study with one sequence: all figures of a variant in a row.
Table overview_table(const StudyResults& results) {
  Table table{.title = "Overview", .header = {"variant"}};
  for (const Variant& variant : results.study.variants)
    table.rows.push_back({{.text = variant.name}});
  for (std::size_t i = 0; i < kMetricCount; ++i) {
    const auto metric = static_cast<MetricId>(i);
    const Metric& m = metrics()[metric];
    const std::optional<Spread> all = results.spread(metric);
    if (m.group != Metric::Group::kAlone || !all || (all->min == 0.0 && all->max == 0.0)) continue;
    table.header.push_back(m.brief + (*m.unit ? " (" + std::string(m.unit) + ")" : ""));
    const std::vector<bool> best = best_variants(results, 0, metric);
    for (std::size_t variant = 0; variant < table.rows.size(); ++variant) {
      table.rows[variant].push_back(metric_cell(results, 0, variant, metric));
      table.rows[variant].back().best = best[variant];
    }
  }
  if (table.header.size() == 1) table.rows.clear();
  return table;
}

Table variants_table(const Study& study) {
  Table table{.title = "Variants", .header = {"variant", "pipeline", "changes"}};
  for (const Variant& variant : study.variants)
    table.rows.push_back({{.text = variant.name},
                          {.text = variant.pipeline},
                          {.text = join(assignments_of(study, variant))}});
  return table;
}

}  // namespace

std::vector<Table> study_tables(const StudyResults& results) {
  std::vector<Table> tables;
  const auto add = [&](Table table) {
    if (!table.rows.empty() || !table.note.empty()) tables.push_back(std::move(table));
  };
  const std::vector<PairedComparison> comparisons = compare_with_baseline(results);
  if (results.study.sequences.size() == 1) add(overview_table(results));
  for (std::size_t metric = 0; metric < kMetricCount; ++metric) {
    if (metrics()[metric].group != Metric::Group::kAlone) continue;
    Table table = metric_table(results, static_cast<MetricId>(metric));
    if (metric == kAte && !table.rows.empty()) mark_significant(results.study, comparisons, table);
    add(std::move(table));
    if (metric != kAte) continue;
    add(comparison_table(results.study, comparisons));
    add(improvement_table(results));
    add(penalty_table(results));
  }
  add(stage_table(results));
  add(error_statistics_table(results));
  add(variants_table(results.study));
  return tables;
}

}  // namespace stillpoint::study
