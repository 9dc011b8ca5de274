#include "report/study_tables.hpp"

#include <algorithm>
#include <string>

#include "evaluation/format.hpp"
#include "report/best_marks.hpp"
#include "study/paired_comparison.hpp"

namespace stillpoint::report {
namespace {

using evaluation::fixed;
using study::MetricId;
using study::Spread;
using study::StudyResults;

constexpr double kSignificance = 0.05;
constexpr const char* kNothing = "–";

bool is_error_of_poses(MetricId metric) {
  return metric == study::kAte || metric == study::kScale || metric == study::kRpeTranslation ||
         metric == study::kRpeRotation;
}

std::string text_of(const Spread& spread, int digits) {
  std::string text = fixed(spread.median, digits);
  if (spread.count > 1)
    text += " (" + fixed(spread.min, digits) + "–" + fixed(spread.max, digits) + ")";
  return text;
}

TableCell cell_of(const StudyResults& results, std::size_t sequence, std::size_t variant,
                  MetricId metric) {
  const auto spread = results.spread(sequence, variant, metric);
  TableCell cell{.text = kNothing};
  if (spread) {
    cell.text = text_of(*spread, study::metrics()[metric].digits);
    cell.value = spread->median;
  }
  const auto coverage = results.spread(sequence, variant, study::kCoverage);
  if (is_error_of_poses(metric) && coverage && fixed(coverage->median, 1) != "100.0")
    cell.text += ", coverage " + fixed(coverage->median, 1) + " %";
  const auto repeats = static_cast<std::size_t>(results.study.repeats);
  if (spread && spread->count < repeats)
    cell.text += " [" + std::to_string(spread->count) + " of " + std::to_string(repeats) + "]";
  return cell;
}

/// Marks the best of a row.
void mark_best_of_row(const StudyResults& results, std::size_t sequence, MetricId metric,
                      std::vector<TableCell>& row) {
  if (metric == study::kScale) return;
  const auto coverage = [&](std::size_t variant) {
    const auto spread = results.spread(sequence, variant, study::kCoverage);
    return spread ? spread->median : 0.0;
  };
  double most = 0.0;
  for (std::size_t v = 0; v + 1 < row.size(); ++v) most = std::max(most, coverage(v));
  std::vector<TableCell*> eligible;
  for (std::size_t v = 0; v + 1 < row.size(); ++v)
    if (row[v + 1].value && (!is_error_of_poses(metric) || most - coverage(v) <= kSameCoverage))
      eligible.push_back(&row[v + 1]);
  const bool larger_is_better = metric == study::kCoverage || metric == study::kSpeed;
  mark_best(eligible, larger_is_better, study::metrics()[metric].digits);
}

Table matrix_of(const StudyResults& results, MetricId metric,
                const std::vector<std::string>& variants) {
  const study::Metric& m = study::metrics()[metric];
  Table table{.title = std::string(m.title) + (*m.unit ? " (" + std::string(m.unit) + ")" : ""),
              .header = {"sequence"}};
  table.header.insert(table.header.end(), variants.begin(), variants.end());
  bool all_zero = true, empty = true;
  for (std::size_t sequence = 0; sequence < results.study.sequences.size(); ++sequence) {
    std::vector<TableCell> row = {{.text = results.study.sequences[sequence].name}};
    for (std::size_t variant = 0; variant < results.study.variants.size(); ++variant) {
      row.push_back(cell_of(results, sequence, variant, metric));
      empty = empty && !row.back().value;
      all_zero = all_zero && row.back().value.value_or(0.0) == 0.0;
    }
    mark_best_of_row(results, sequence, metric, row);
    table.rows.push_back(std::move(row));
  }
  if (empty || all_zero) table.rows.clear();
  return table;
}

TableCell number_cell(double value, int digits) {
  return {.text = fixed(value, digits), .value = value};
}

TableCell ratio_cell(const std::optional<Spread>& ratio) {
  if (!ratio) return {.text = kNothing};
  std::string text = fixed(ratio->median, 2);
  if (ratio->count > 1)
    text += " (" + fixed(ratio->first_quartile, 2) + "–" + fixed(ratio->third_quartile, 2) + ")";
  return {.text = std::move(text), .value = ratio->median};
}

Table comparison_table(const StudyResults& results,
                       const std::vector<study::PairedComparison>& comparisons) {
  Table table{
      .title = "Compared with " + results.study.baseline + ", recording by recording",
      .note =
          "Ratios: median (quartiles); below 1 the variant has the smaller error, or takes less "
          "time. By coverage: recordings on which one of the two failed, covered less or lost "
          "its way, and so is the worse one. Effect: 1, the variant is always better; -1, "
          "always worse. p: Wilcoxon's signed-rank test of the ATE, two-sided, corrected for "
          "the number of variants after Holm.",
      .header = {"variant", "better", "worse", "by coverage", "ATE ratio", "CPU ratio", "effect",
                 "p", "corrected p"}};
  const auto p_cell = [](double p) {
    return TableCell{.text = p < 0.0001 ? "< 0.0001" : fixed(p, 4), .value = p};
  };
  for (const study::PairedComparison& one : comparisons) {
    table.rows.push_back({{.text = results.study.variants[one.variant].name},
                          number_cell(static_cast<double>(one.better), 0),
                          number_cell(static_cast<double>(one.worse), 0),
                          number_cell(static_cast<double>(one.incomplete), 0),
                          ratio_cell(one.ate_ratio),
                          ratio_cell(one.time_ratio),
                          number_cell(one.effect, 2),
                          p_cell(one.p),
                          p_cell(one.corrected_p)});
    table.rows.back().back().significant = one.corrected_p < kSignificance;
  }
  return table;
}

Table improvement_table(const StudyResults& results, const std::vector<std::string>& variants) {
  Table table{.title = "Improvement of the ATE over " + results.study.baseline + " (%)",
              .note =
                  "Of each repeat, with the baseline's run of the same seed: median "
                  "(smallest–largest).",
              .header = {"sequence"}};
  table.header.insert(table.header.end(), variants.begin(), variants.end());
  bool any = false;
  for (std::size_t sequence = 0; sequence < results.study.sequences.size(); ++sequence) {
    std::vector<TableCell> row = {{.text = results.study.sequences[sequence].name}};
    for (std::size_t variant = 0; variant < results.study.variants.size(); ++variant) {
      const auto spread = study::improvement_percent(results, sequence, variant);
      TableCell cell{.text = kNothing};
      if (spread) {
        cell.text = fixed(spread->median, 1);
        if (spread->count > 1)
          cell.text += " (" + fixed(spread->min, 1) + " to " + fixed(spread->max, 1) + ")";
        cell.value = spread->median;
      }
      any = any || cell.value;
      row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  if (!any) table.rows.clear();
  return table;
}

std::string note_of_matrices(const StudyResults& results, bool any_significant) {
  std::string note =
      results.study.repeats > 1
          ? "Median (smallest–largest) of " + std::to_string(results.study.repeats) + " runs."
          : "One run of each.";
  note += " Bold: the best of its row, among variants that cover the same up to 1 %.";
  if (any_significant)
    note +=
        " †: differs from " + results.study.baseline + " over all recordings, corrected p < 0.05.";
  return note;
}

Table variants_table(const study::Study& study) {
  Table table{.title = "Variants", .header = {"variant", "pipeline", "changes"}};
  for (const study::Variant& variant : study.variants) {
    std::string changes;
    for (const std::string& assignment : assignments_of(study, variant))
      changes += (changes.empty() ? "" : ", ") + assignment;
    table.rows.push_back({{.text = variant.name}, {.text = variant.pipeline}, {.text = changes}});
  }
  return table;
}

}  // namespace

std::vector<Table> study_tables(const StudyResults& results) {
  const std::vector<study::PairedComparison> comparisons = compare_with_baseline(results);
  std::vector<std::string> names;
  for (const study::Variant& variant : results.study.variants) names.push_back(variant.name);
  std::vector<std::string> marked = names;
  bool any_significant = false;
  for (const study::PairedComparison& one : comparisons) {
    if (one.corrected_p >= kSignificance) continue;
    marked[one.variant] += " †";
    any_significant = true;
  }
  std::vector<Table> tables;
  const auto add = [&](Table table) {
    if (!table.rows.empty()) tables.push_back(std::move(table));
  };
  for (std::size_t metric = 0; metric < study::kMetricCount; ++metric) {
    if (study::metrics()[metric].group != study::Metric::Group::kAlone) continue;
    Table table =
        matrix_of(results, static_cast<MetricId>(metric), metric == study::kAte ? marked : names);
    table.note = note_of_matrices(results, metric == study::kAte && any_significant);
    add(std::move(table));
    if (metric != study::kAte) continue;
    add(comparison_table(results, comparisons));
    add(improvement_table(results, names));
  }
  add(variants_table(results.study));
  return tables;
}

}  // namespace stillpoint::report
