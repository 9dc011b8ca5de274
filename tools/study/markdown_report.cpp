#include "study/markdown_report.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "evaluation/format.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "study/markdown_table.hpp"
#include "study/paired_comparison.hpp"

namespace stillpoint::study {
namespace {

using evaluation::fixed;

constexpr const char* kNothing = "–";

std::string heading(const std::string& title, const std::string& unit) {
  return "\n## " + title + (unit.empty() ? "" : " (" + unit + ")") + "\n\n";
}

/// The text of one sequence with one variant.
using CellText = std::function<std::string(std::size_t sequence, std::size_t variant)>;

/// Sequences × variants. Without rows in which there is nothing; empty when that leaves none.
std::string matrix(const Study& study, const CellText& text_of) {
  std::vector<std::string> header = {"sequence"};
  for (const Variant& variant : study.variants) header.push_back(variant.name);
  std::vector<std::vector<std::string>> rows;
  for (std::size_t sequence = 0; sequence < study.sequences.size(); ++sequence) {
    std::vector<std::string> row = {study.sequences[sequence].name};
    bool empty = true;
    for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
      row.push_back(text_of(sequence, variant));
      empty = empty && row.back() == kNothing;
    }
    if (!empty) rows.push_back(std::move(row));
  }
  return rows.empty() ? "" : markdown_table(header, rows);
}

bool is_error(MetricId metric) {
  return metric == kAte || metric == kScale || metric == kRpeTranslation || metric == kRpeRotation;
}

// An error of a part of the recording is no error of the whole.
std::string coverage_note(const StudyResults& results, std::size_t sequence, std::size_t variant) {
  const auto coverage = results.spread(sequence, variant, kCoverage);
  const std::string percent = coverage ? fixed(coverage->median, 1) : "100.0";
  return percent == "100.0" ? "" : ", coverage " + percent + " %";
}

/// "0.0021 (0.0020–0.0022)", "5.0 (-3.0 to 9.0)"
std::string spread_text(const Spread& spread, int digits) {
  std::string text = fixed(spread.median, digits);
  if (spread.count > 1)
    text += " (" + fixed(spread.min, digits) + (spread.min < 0.0 ? " to " : "–") +
            fixed(spread.max, digits) + ")";
  return text;
}

std::string metric_text(const StudyResults& results, std::size_t sequence, std::size_t variant,
                        MetricId metric) {
  const auto spread = results.spread(sequence, variant, metric);
  const bool error = is_error(metric);
  if (!spread) return kNothing + (error ? coverage_note(results, sequence, variant) : "");
  std::string text = spread_text(*spread, metrics()[metric].digits);
  if (error) text += coverage_note(results, sequence, variant);
  const auto repeats = static_cast<std::size_t>(results.study.repeats);
  if (spread->count < repeats)
    text += " [" + std::to_string(spread->count) + " of " + std::to_string(repeats) + "]";
  return text;
}

std::vector<double> values_of(const StudyResults& results, MetricId metric) {
  std::vector<double> values;
  for (const std::optional<CellResult>& result : results.results)
    if (result && result->values[metric]) values.push_back(*result->values[metric]);
  return values;
}

std::string metric_section(const StudyResults& results, MetricId metric) {
  const std::optional<Spread> all = spread_of(values_of(results, metric));
  if (!all) return {};
  const Metric& m = metrics()[metric];
  if (all->min == 0.0 && all->max == 0.0) return heading(m.title, m.unit) + "0 in every run.\n";
  return heading(m.title, m.unit) +
         matrix(results.study, [&](std::size_t sequence, std::size_t variant) {
           return metric_text(results, sequence, variant, metric);
         });
}

/// Of a study with one sequence: all figures of a variant in a row.
std::string overview_section(const StudyResults& results) {
  if (results.study.sequences.size() != 1) return {};
  std::vector<std::string> header = {"variant"};
  std::vector<MetricId> shown;
  for (std::size_t i = 0; i < kMetricCount; ++i) {
    const auto metric = static_cast<MetricId>(i);
    const std::optional<Spread> all = spread_of(values_of(results, metric));
    if (!all || (all->min == 0.0 && all->max == 0.0)) continue;
    const Metric& m = metrics()[metric];
    shown.push_back(metric);
    header.push_back(std::string(m.brief) + (*m.unit ? " (" + std::string(m.unit) + ")" : ""));
  }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t variant = 0; variant < results.study.variants.size(); ++variant) {
    rows.push_back({results.study.variants[variant].name});
    for (const MetricId metric : shown)
      rows.back().push_back(metric_text(results, 0, variant, metric));
  }
  return shown.empty() ? "" : heading("Overview", "") + markdown_table(header, rows);
}

std::string penalty_section(const StudyResults& results) {
  const std::string table = matrix(results.study, [&](std::size_t sequence, std::size_t variant) {
    const auto value = dynamic_penalty(results, sequence, variant);
    return value ? fixed(*value, 2) + coverage_note(results, sequence, variant) : kNothing;
  });
  return table.empty() ? "" : heading("Dynamic penalty: ATE ÷ ATE on the _empty twin", "") + table;
}

std::string improvement_section(const StudyResults& results) {
  const std::string table = matrix(results.study, [&](std::size_t sequence, std::size_t variant) {
    const auto value = improvement_percent(results, sequence, variant);
    return value ? spread_text(*value, 1) + coverage_note(results, sequence, variant) : kNothing;
  });
  if (table.empty()) return {};
  return heading("Improvement of the ATE over " + results.study.baseline, "%") + table;
}

std::string ratio_text(const std::optional<Spread>& ratio) {
  if (!ratio) return kNothing;
  std::string text = fixed(ratio->median, 2);
  if (ratio->count > 1)
    text += " (" + fixed(ratio->first_quartile, 2) + "–" + fixed(ratio->third_quartile, 2) + ")";
  return text;
}

std::string p_text(double p) { return p < 0.0001 ? "< 0.0001" : fixed(p, 4); }

std::string comparison_section(const StudyResults& results) {
  std::vector<std::vector<std::string>> rows;
  for (const PairedComparison& one : compare_with_baseline(results)) {
    rows.push_back({results.study.variants[one.variant].name, std::to_string(one.better),
                    std::to_string(one.worse), std::to_string(one.incomplete),
                    ratio_text(one.ate_ratio), ratio_text(one.time_ratio), fixed(one.effect, 2),
                    p_text(one.p), p_text(one.corrected_p)});
  }
  if (rows.empty()) return {};
  return heading("Compared with " + results.study.baseline + ", recording by recording", "") +
         markdown_table({"variant", "better", "worse", "by coverage", "ATE ratio", "CPU ratio",
                         "effect", "p", "corrected p"},
                        rows) +
         "\nRatios: median (quartiles); below 1 the variant has the smaller error, or takes less "
         "time. "
         "*By coverage*: recordings on which one of the two failed, covered less or lost its way, "
         "and "
         "so is the worse one. Effect: 1, the variant is always better; -1, always worse. p: "
         "Wilcoxon's signed-rank test of the ATE, two-sided; corrected for the number of variants "
         "after Holm.\n";
}

std::string text_of(const Origin& origin) {
  if (origin.version.empty()) return "a build that has left no record";
  std::string text = "Stillpoint " + origin.version;
  if (!origin.commit.empty()) text += ", commit " + origin.commit;
  return text + "; " + origin.machine;
}

/// Runs that one build made on one machine.
struct Batch {
  std::string made_by;
  std::string first_date, last_date;
  std::size_t runs = 0;
};

std::vector<Batch> batches_of(const StudyResults& results) {
  std::vector<Batch> batches;
  for (const std::optional<CellResult>& result : results.results) {
    if (!result) continue;
    const std::string made_by = text_of(result->origin), &date = result->origin.date;
    auto batch = std::ranges::find(batches, made_by, &Batch::made_by);
    if (batch == batches.end()) batch = batches.insert(batches.end(), {made_by, date, date});
    batch->first_date = std::min(batch->first_date, date);
    batch->last_date = std::max(batch->last_date, date);
    ++batch->runs;
  }
  return batches;
}

/// The command that repeats the runs; which builds made them, where and when.
std::string origins(const StudyResults& results) {
  std::string text = results.command.empty() ? "" : "\n`" + results.command + "`\n";
  const std::vector<Batch> batches = batches_of(results);
  const std::string total = std::to_string(results.results.size() - results.missing());
  for (const Batch& batch : batches) {
    text += "\n";
    if (batches.size() > 1) text += "* " + std::to_string(batch.runs) + " of " + total + " runs: ";
    text += batch.made_by;
    if (!batch.first_date.empty()) text += "; " + batch.first_date;
    if (batch.last_date != batch.first_date) text += " to " + batch.last_date;
  }
  return batches.empty() ? text : text + "\n";
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

std::string variants_section(const Study& study) {
  std::vector<std::vector<std::string>> rows;
  for (const Variant& variant : study.variants)
    rows.push_back({variant.name, variant.pipeline, join(assignments_of(study, variant))});
  return heading("Variants", "") + markdown_table({"variant", "pipeline", "changes"}, rows);
}

/// Runs that say something: they failed, or cannot be compared with the truth.
std::string remarks_section(const StudyResults& results) {
  std::string text;
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    const std::optional<CellResult>& result = results.results[i];
    if (!result || result->message.empty()) continue;
    text += "* " + name_of(results.study, results.cells[i]) + ": " +
            (result->failed() ? "exit code " + std::to_string(result->exit_code) + ": " : "") +
            result->message + "\n";
  }
  return text.empty() ? "" : heading("Runs that failed or cannot be compared", "") + text;
}

}  // namespace

std::string markdown_report(const StudyResults& results, const std::string& title) {
  std::string text = "# " + title + "\n\n" + introduction(results);
  text += overview_section(results) + metric_section(results, kAte);
  text += comparison_section(results) + improvement_section(results) + penalty_section(results);
  for (std::size_t metric = kAte + 1; metric < kMetricCount; ++metric)
    text += metric_section(results, static_cast<MetricId>(metric));
  return text + variants_section(results.study) + remarks_section(results);
}

}  // namespace stillpoint::study
