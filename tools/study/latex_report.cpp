#include "study/latex_report.hpp"

#include <algorithm>
#include <utility>
#include <vector>

#include "evaluation/format.hpp"
#include "study/latex_cells.hpp"
#include "study/latex_table.hpp"
#include "study/paired_comparison.hpp"
#include "study/provenance.hpp"
#include "study/table_cells.hpp"

namespace stillpoint::study {
namespace {

using evaluation::fixed;

class LatexReport {
 public:
  LatexReport(const StudyResults& results, std::string title)
      : results_(results),
        study_(results.study),
        title_(std::move(title)),
        comparisons_(compare_with_baseline(results)) {}

  std::string text() const {
    std::string text = "% Needs \\usepackage{booktabs}. Tables of the study " + title_ + ".\n";
    if (!results_.command.empty()) text += "% " + results_.command + "\n";
    for (const std::string& line : provenance(results_)) text += "% " + line + "\n";
    std::vector<LatexTable> tables = {ate_table()};
    for (const ErrorFigures& figures : error_figures()) tables.push_back(error_table(figures));
    tables.push_back(comparison_table());
    tables.push_back(improvement_table());
    tables.push_back(time_table());
    for (const LatexTable& table : tables)
      if (!table.rows.empty()) text += latex_table(table);
    return text;
  }

 private:
  std::string label(const std::string& name) const { return title_ + "-" + name; }

  std::string runs_note(const std::string& figure) const {
    if (study_.repeats == 1) return " One run of each.";
    return " " + figure + " of " + std::to_string(study_.repeats) + " runs.";
  }

  /// At the end of every caption.
  std::string missing_note() const {
    if (results_.missing() == 0) return {};
    return " Not finished: " + std::to_string(results_.missing()) + " of " +
           std::to_string(results_.cells.size()) + " runs are missing.";
  }

  /// What † in the header says.
  std::string dagger_note() const {
    const std::string note = significance_note(study_, comparisons_);
    return note.empty() ? "" : " " + latex_text(note);
  }

  /// Systems with the same source together.
  static std::string published_note(const std::vector<const Published*>& systems) {
    std::string text;
    for (std::size_t i = 0; i < systems.size(); ++i) {
      text += (i == 0 ? " In italics, as published: " : "") + latex_text(systems[i]->name);
      const bool last = i + 1 == systems.size();
      if (!last && systems[i + 1]->source == systems[i]->source)
        text += ", ";
      else
        text += ": " + latex_text(systems[i]->source) + (last ? "." : "; ");
    }
    return text;
  }

  /// A part of a sequence, or of the runs that `figure` is of: it says less than that of the whole.
  std::string partial_note(std::size_t sequence, std::size_t variant,
                           const std::optional<Spread>& figure) const {
    std::string note = partial_coverage(results_, sequence, variant, "--");
    if (!note.empty()) note += "\\,\\%";
    const auto repeats = static_cast<std::size_t>(study_.repeats);
    if (figure && figure->count < repeats)
      note += (note.empty() ? "" : ", ") + std::to_string(figure->count) + " of " +
              std::to_string(repeats);
    if (!figure && results_.all_failed(sequence, variant)) note = "failed";
    return latex_limit(note);
  }

  void add_systems(const std::vector<const Published*>& systems, LatexTable& table) const {
    for (const Variant& variant : study_.variants) table.header.push_back(latex_text(variant.name));
    for (const Published* system : systems)
      table.header.push_back(latex_italic(latex_text(system->name)));
    table.columns += std::string(study_.variants.size() + systems.size(), 'r');
  }

  LatexTable ate_table() const {
    const auto systems = published_with(study_, kAte, kAte + 1);
    LatexTable table{
        .label = label("ate"),
        .caption = "Absolute trajectory error, RMSE (m)." + runs_note("Median (smallest--largest)"),
        .columns = "l",
        .header = {"Sequence"},
        .rows = {}};
    add_systems(systems, table);
    for (const PairedComparison& one : comparisons_)
      if (one.is_significant()) table.header[one.variant + 1] += latex_text("†");
    for (std::size_t sequence = 0; sequence < study_.sequences.size(); ++sequence) {
      const auto best = best_variants(results_, sequence, kAte);
      std::vector<std::string> row = {latex_text(study_.sequences[sequence].name)};
      for (std::size_t variant = 0; variant < study_.variants.size(); ++variant) {
        const auto error = results_.spread(sequence, variant, kAte);
        row.push_back(latex_spread(error, metrics()[kAte].digits, best[variant]) +
                      partial_note(sequence, variant, error));
      }
      for (const Published* system : systems)
        row.push_back(latex_published(*system, original_of(study_.sequences[sequence]), kAte));
      table.rows.push_back(std::move(row));
    }
    table.caption +=
        brackets_note(table) +
        bold_note(table, " Bold: the smallest of its row" + latex_text(among_comparable())) +
        dagger_note() + published_note(systems) + missing_note();
    return table;
  }

  /// Equation 7 of the DS-SLAM paper, as in its Tables I to III.
  LatexTable improvement_table() const {
    LatexTable table{.label = label("improvement"),
                     .caption = "Improvement of the absolute trajectory error over " +
                                latex_text(study_.baseline) + " (\\%)." +
                                runs_note("Median (smallest--largest)"),
                     .columns = "l",
                     .header = {"Sequence"},
                     .rows = {}};
    std::vector<std::size_t> others;
    for (std::size_t variant = 0; variant < study_.variants.size(); ++variant)
      if (study_.variants[variant].name != study_.baseline) others.push_back(variant);
    for (const std::size_t variant : others)
      table.header.push_back(latex_text(study_.variants[variant].name));
    table.columns += std::string(others.size(), 'r');
    for (std::size_t sequence = 0; sequence < study_.sequences.size(); ++sequence) {
      std::vector<std::string> row = {latex_text(study_.sequences[sequence].name)};
      bool any = false;
      for (const std::size_t variant : others) {
        const auto percent = improvement_percent(results_, sequence, variant);
        row.push_back(latex_spread(percent, 1) + partial_note(sequence, variant, percent));
        const std::string covered =
            partial_coverage(results_, sequence, *baseline_of(study_), "--");
        if (percent && !covered.empty())
          row.back() += latex_limit("baseline " + covered + "\\,\\%");
        any |= percent.has_value();
      }
      if (any) table.rows.push_back(std::move(row));
    }
    table.caption += brackets_note(table) + missing_note();
    return table;
  }

  /// The form of Tables I to III of the DS-SLAM paper, a system a row.
  LatexTable error_table(const ErrorFigures& figures) const {
    const auto systems = published_with(study_, figures.rmse, figures.rmse + 1);
    const Metric& m = metrics()[figures.rmse];
    LatexTable table{
        .label = label(m.key),
        .caption = latex_text(figures.brief) + " (" + m.unit + ")." + runs_note("Median"),
        .columns = "llrrrr",
        .header = {"Sequence", "System", "RMSE", "Mean", "Median", "S.D."},
        .rows = {}};
    for (std::size_t sequence = 0; sequence < study_.sequences.size(); ++sequence)
      add_error_rows(figures, sequence, systems, table.rows);
    table.caption +=
        brackets_note(table) +
        bold_note(table, " Bold: the smallest of a sequence" + latex_text(among_comparable())) +
        (has_italics(table) ? published_note(systems) : "") + missing_note();
    return table;
  }

  void add_error_rows(const ErrorFigures& figures, std::size_t sequence,
                      const std::vector<const Published*>& systems,
                      std::vector<std::vector<std::string>>& rows) const {
    std::vector<std::vector<bool>> best;
    for (const MetricId metric : figures.all())
      best.push_back(best_variants(results_, sequence, metric));
    std::string name = latex_text(study_.sequences[sequence].name);  // in the first row only
    for (std::size_t variant = 0; variant < study_.variants.size(); ++variant) {
      const auto rmse = results_.spread(sequence, variant, figures.rmse);
      if (!rmse && !results_.all_failed(sequence, variant)) continue;
      if (!rows.empty() && !name.empty()) rows.emplace_back();
      rows.push_back({std::exchange(name, ""), latex_text(study_.variants[variant].name)});
      for (std::size_t i = 0; i < best.size(); ++i) {
        const MetricId metric = figures.all()[i];
        const auto spread = results_.spread(sequence, variant, metric);
        const std::string text =
            spread ? fixed(spread->median, metrics()[metric].digits) : kNoFigure;
        rows.back().push_back(best[i][variant] ? latex_bold(text) : text);
        if (i == 0) rows.back().back() += partial_note(sequence, variant, rmse);
      }
    }
    if (!name.empty()) return;  // nothing has been measured
    const std::string original = original_of(study_.sequences[sequence]);
    for (const Published* system : systems) {
      if (!system->find(original, figures.rmse)) continue;
      rows.push_back({"", latex_italic(latex_text(system->name))});
      for (const MetricId metric : figures.all())
        rows.back().push_back(latex_published(*system, original, metric));
    }
  }

  LatexTable comparison_table() const {
    std::string notes;
    for (const std::string& note : {left_out_note(study_), recordings_note(comparisons_)})
      if (!note.empty()) notes += " " + note;
    LatexTable table{
        .label = label("comparison"),
        .caption = "Compared with " + latex_text(study_.baseline) +
                   ", recording by recording ($n$ of them; by loss: those on which one of "
                   "the two failed, lost tracking or covered less, and so is the worse one). "
                   "Ratios: median (quartiles); effect: matched-pairs "
                   "rank-biserial correlation, 1 where the variant is always better; $p$: "
                   "Wilcoxon's signed-rank test of the absolute trajectory error, two-sided, "
                   "corrected after Holm.",
        .columns = "lrrrrrrrr",
        .header = {"Variant", "$n$", "Better", "Worse", "By loss", "ATE ratio", "CPU ratio",
                   "Effect", "$p$"},
        .rows = {}};
    for (const PairedComparison& one : comparisons_) {
      std::string p = one.corrected_p < 0.0001 ? "$<$0.0001" : fixed(one.corrected_p, 4);
      if (!one.can_be_significant())
        p += " {\\scriptsize (at least " + fixed(one.least_p, 4) + ")}";
      table.rows.push_back({latex_text(study_.variants[one.variant].name),
                            std::to_string(one.recordings), std::to_string(one.better),
                            std::to_string(one.worse), std::to_string(one.incomplete),
                            latex_ratio(one.ate_ratio), latex_ratio(one.time_ratio),
                            fixed(one.effect, 2), one.is_significant() ? latex_bold(p) : p});
    }
    table.caption += bold_note(table, " Bold: below 0.05.") + notes + missing_note();
    return table;
  }

  /// The form of Table IV.
  LatexTable time_table() const {
    const auto systems = published_with_stages_of(results_);
    LatexTable table{.label = label("times"),
                     .caption =
                         "Time of each stage, mean of its calls (ms, wall clock), over all "
                         "sequences: median (smallest--largest) of the runs." +
                         published_note(systems) + missing_note(),
                     .columns = "l",
                     .header = {"Stage"},
                     .rows = {}};
    add_systems(systems, table);
    for (std::size_t i = kFirstStage; i < kMetricCount; ++i) {
      const auto metric = static_cast<MetricId>(i);
      const Metric& m = metrics()[metric];
      if (!results_.spread(metric)) continue;
      std::vector<std::string> row = {latex_text(m.title)};
      for (std::size_t variant = 0; variant < study_.variants.size(); ++variant)
        row.push_back(latex_spread(results_.spread(variant, metric), m.digits));
      for (const Published* system : systems) row.push_back(latex_published(*system, "", metric));
      table.rows.push_back(std::move(row));
    }
    return table;
  }

  const StudyResults& results_;
  const Study& study_;
  const std::string title_;
  const std::vector<PairedComparison> comparisons_;
};

}  // namespace

std::string latex_report(const StudyResults& results, const std::string& title) {
  return LatexReport(results, title).text();
}

}  // namespace stillpoint::study
