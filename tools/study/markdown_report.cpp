#include "study/markdown_report.hpp"

#include <algorithm>
#include <functional>
#include <vector>

#include "evaluation/format.hpp"
#include "stillpoint/support/did_you_mean.hpp"
#include "study/markdown_table.hpp"
#include "study/paired_comparison.hpp"
#include "study/provenance.hpp"

namespace stillpoint::study {
namespace {

using evaluation::fixed;

constexpr const char* kNothing = "–";

std::string heading(const std::string& title, const std::string& unit) {
  return "\n## " + title + (unit.empty() ? "" : " (" + unit + ")") + "\n\n";
}

/// The text of one sequence with one variant.
using CellText = std::function<std::string(std::size_t sequence, std::size_t variant)>;

std::string published_name(const Published& system) { return system.name + " (published)"; }

std::string published_text(const Published& system, const std::string& recording, MetricId metric) {
  const auto value = system.find(recording, metric);
  return value ? fixed(*value, metrics()[metric].digits) : kNothing;
}

/// Sequences × variants, and what others have published of `metric`. Without rows in which there is
/// nothing; empty when that leaves none.
std::string matrix(const Study& study, const CellText& text_of,
                   const std::optional<MetricId>& metric = {}) {
  std::vector<std::string> header = {"sequence"};
  for (const Variant& variant : study.variants) header.push_back(variant.name);
  std::vector<const Published*> systems;
  if (metric) systems = published_with(study, *metric, *metric + 1);
  for (const Published* system : systems) header.push_back(published_name(*system));
  std::vector<std::vector<std::string>> rows;
  for (std::size_t sequence = 0; sequence < study.sequences.size(); ++sequence) {
    std::vector<std::string> row = {study.sequences[sequence].name};
    bool empty = true;
    for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
      row.push_back(text_of(sequence, variant));
      empty = empty && row.back() == kNothing;
    }
    for (const Published* system : systems)
      row.push_back(published_text(*system, original_of(study.sequences[sequence]), *metric));
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
  return heading(m.title, m.unit) + matrix(
                                        results.study,
                                        [&](std::size_t sequence, std::size_t variant) {
                                          return metric_text(results, sequence, variant, metric);
                                        },
                                        metric);
}

/// Below the first table that shows them.
std::string published_note(const Study& study) {
  if (study.published.empty()) return {};
  std::string text = "\nPublished, not measured here";
  if (std::ranges::any_of(study.sequences, [](const Sequence& s) { return !s.scene.empty(); }))
    text += ", on the original recordings, of which simulated ones are only twins";
  text += ":\n\n";
  for (const Published& system : study.published)
    text += "* " + system.name + ": " + system.source + "\n";
  return text;
}

/// The rows of one sequence: RMSE, mean, median and S.D. of each kind of error.
void add_error_rows(const StudyResults& results, std::size_t sequence,
                    std::vector<std::vector<std::string>>& rows) {
  const Study& study = results.study;
  const std::string& name = study.sequences[sequence].name;
  const auto add = [&](const std::string& system, const auto& text_of) {
    std::vector<std::string> row = {name, system};
    for (const ErrorFigures& figures : error_figures())
      for (const MetricId metric : figures.all()) row.push_back(text_of(metric));
    if (std::any_of(row.begin() + 2, row.end(), [](const auto& t) { return t != kNothing; }))
      rows.push_back(std::move(row));
  };
  for (std::size_t variant = 0; variant < study.variants.size(); ++variant)
    add(study.variants[variant].name, [&](MetricId metric) -> std::string {
      const auto spread = results.spread(sequence, variant, metric);
      return spread ? fixed(spread->median, metrics()[metric].digits) : kNothing;
    });
  for (const Published& system : study.published)
    add(published_name(system), [&](MetricId metric) {
      return published_text(system, original_of(study.sequences[sequence]), metric);
    });
}

/// The form of Tables I to III of the DS-SLAM paper.
std::string error_statistics_section(const StudyResults& results) {
  if (values_of(results, kAteMean).empty()) return {};
  std::vector<std::string> header = {"sequence", "variant"};
  for (const ErrorFigures& figures : error_figures())
    for (const MetricId metric : figures.all()) {
      const Metric& m = metrics()[metric];
      header.push_back(metric == figures.rmse
                           ? std::string(figures.brief) + ", RMSE (" + m.unit + ")"
                           : m.brief);
    }
  std::vector<std::vector<std::string>> rows;
  for (std::size_t sequence = 0; sequence < results.study.sequences.size(); ++sequence)
    add_error_rows(results, sequence, rows);
  return heading("RMSE, mean, median and standard deviation of the errors", "") +
         markdown_table(header, rows);
}

/// The form of Table IV: of all sequences together.
std::string stage_section(const StudyResults& results) {
  const Study& study = results.study;
  std::vector<std::string> header = {"stage"};
  for (const Variant& variant : study.variants) header.push_back(variant.name);
  const auto systems = published_with(study, kFirstStage, kMetricCount);
  for (const Published* system : systems) header.push_back(published_name(*system));
  std::vector<std::vector<std::string>> rows;
  for (std::size_t i = kFirstStage; i < kMetricCount; ++i) {
    const auto metric = static_cast<MetricId>(i);
    if (values_of(results, metric).empty()) continue;
    const Metric& m = metrics()[metric];
    rows.push_back({std::string(m.title) + " (`" + m.brief + "`)"});
    for (std::size_t variant = 0; variant < study.variants.size(); ++variant) {
      const auto spread = results.spread(variant, metric);
      rows.back().push_back(spread ? spread_text(*spread, m.digits) : kNothing);
    }
    for (const Published* system : systems)
      rows.back().push_back(published_text(*system, "", metric));
  }
  if (rows.empty()) return {};
  return heading("Time of each stage, mean of its calls", "ms") + markdown_table(header, rows) +
         "\nWall clock; all sequences together.\n";
}

/// Of a study with one sequence: all figures of a variant in a row.
std::string overview_section(const StudyResults& results) {
  if (results.study.sequences.size() != 1) return {};
  std::vector<std::string> header = {"variant"};
  std::vector<MetricId> shown;
  for (std::size_t i = 0; i < kMetricCount; ++i) {
    const auto metric = static_cast<MetricId>(i);
    if (metrics()[metric].group != Metric::Group::kAlone) continue;
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
  std::string text = "# " + title + "\n\n";
  if (!results.study.question.empty()) text += results.study.question + "\n\n";
  text += introduction(results) + overview_section(results) + metric_section(results, kAte);
  text += published_note(results.study);
  text += comparison_section(results) + improvement_section(results) + penalty_section(results);
  for (std::size_t metric = kAte + 1; metric < kMetricCount; ++metric)
    if (metrics()[metric].group == Metric::Group::kAlone)
      text += metric_section(results, static_cast<MetricId>(metric));
  text += stage_section(results) + error_statistics_section(results);
  return text + variants_section(results.study) + remarks_section(results);
}

}  // namespace stillpoint::study
