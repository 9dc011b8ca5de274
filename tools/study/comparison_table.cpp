#include "study/comparison_table.hpp"

#include "evaluation/format.hpp"
#include "study/table_cells.hpp"

namespace stillpoint::study {
namespace {

constexpr const char* kComparisonNote =
    "Ratios: median (quartiles); below 1 the variant has the smaller error, or takes less time. By "
    "loss or coverage: recordings on which one of the two failed, lost tracking or covered less, "
    "and so is the worse one. Effect: 1, the variant is always better; -1, always worse. p: "
    "Wilcoxon's "
    "signed-rank test of the ATE, two-sided; corrected for the number of variants after Holm.";

TableCell count_cell(std::size_t count) { return number_cell(static_cast<double>(count), 0); }

TableCell p_cell(double p) {
  TableCell cell = number_cell(p, 4);
  if (p < 0.0001) cell.text = "< 0.0001";
  return cell;
}

TableCell corrected_cell(const PairedComparison& one) {
  TableCell cell = p_cell(one.corrected_p);
  if (!one.can_be_significant())
    cell.text += " (at least " + evaluation::fixed(one.least_p, 4) + ")";
  cell.significant = one.is_significant();
  return cell;
}

}  // namespace

Table comparison_table(const Study& study, const std::vector<PairedComparison>& comparisons) {
  if (comparisons.empty()) return {};
  Table table{.title = "Compared with " + study.baseline + ", recording by recording",
              .note = kComparisonNote,
              .header = {"variant", "recordings", "better", "worse", "by loss or coverage",
                         "ATE ratio", "CPU ratio", "effect", "p", "corrected p"}};
  for (const std::string& note : {left_out_note(study), recordings_note(comparisons)})
    if (!note.empty()) table.note += " " + note;
  for (const PairedComparison& one : comparisons) {
    table.rows.push_back({{.text = study.variants[one.variant].name},
                          count_cell(one.recordings),
                          count_cell(one.better),
                          count_cell(one.worse),
                          count_cell(one.incomplete),
                          ratio_cell(one.ate_ratio),
                          ratio_cell(one.time_ratio),
                          number_cell(one.effect, 2),
                          p_cell(one.p),
                          corrected_cell(one)});
  }
  return table;
}

}  // namespace stillpoint::study
