#include "study/table_cells.hpp"

#include "evaluation/format.hpp"

namespace stillpoint::study {

using evaluation::fixed;

TableCell spread_cell(const std::optional<Spread>& spread, int digits) {
  if (!spread) return {.text = kNothing};
  TableCell cell = number_cell(spread->median, digits);
  if (spread->count > 1)
    cell.text += " (" + fixed(spread->min, digits) + (spread->min < 0.0 ? " to " : "–") +
                 fixed(spread->max, digits) + ")";
  return cell;
}

int ratio_digits(const Spread& ratio) { return ratio.first_quartile < 0.1 ? 4 : 2; }

TableCell ratio_cell(const std::optional<Spread>& ratio) {
  if (!ratio) return {.text = kNothing};
  const int digits = ratio_digits(*ratio);
  TableCell cell = number_cell(ratio->median, digits);
  if (ratio->count > 1)
    cell.text += " (" + fixed(ratio->first_quartile, digits) + "–" +
                 fixed(ratio->third_quartile, digits) + ")";
  return cell;
}

TableCell number_cell(double value, int digits) {
  return {.text = fixed(value, digits), .value = value};
}

std::string partial_coverage(const StudyResults& results, std::size_t sequence, std::size_t variant,
                             const std::string& dash) {
  const auto coverage = results.spread(sequence, variant, kCoverage);
  if (!coverage) return "";
  const std::string least = fixed(coverage->min, 1), most = fixed(coverage->max, 1);
  if (least == "100.0") return "";
  return least == most ? least : least + dash + most;
}

std::string coverage_note(const StudyResults& results, std::size_t sequence, std::size_t variant) {
  const std::string covered = partial_coverage(results, sequence, variant, "–");
  return covered.empty() ? "" : ", coverage " + covered + " %";
}

std::string count_note(const Spread& spread, int repeats) {
  if (spread.count >= static_cast<std::size_t>(repeats)) return "";
  return " [" + std::to_string(spread.count) + " of " + std::to_string(repeats) + "]";
}

TableCell metric_cell(const StudyResults& results, std::size_t sequence, std::size_t variant,
                      MetricId metric) {
  const auto spread = results.spread(sequence, variant, metric);
  TableCell cell = spread_cell(spread, metrics()[metric].digits);
  if (metrics()[metric].is_pose_error) cell.text += coverage_note(results, sequence, variant);
  if (spread) cell.text += count_note(*spread, results.study.repeats);
  return cell;
}

TableCell published_cell(const Published& system, const std::string& recording, MetricId metric) {
  const auto value = system.find(recording, metric);
  return value ? number_cell(*value, metrics()[metric].digits) : TableCell{.text = kNothing};
}

std::vector<const Published*> published_with_stages_of(const StudyResults& results) {
  std::vector<const Published*> systems;
  for (const Published& system : results.study.published)
    for (std::size_t stage = kFirstStage; stage < kMetricCount; ++stage) {
      const auto metric = static_cast<MetricId>(stage);
      if (!results.spread(metric) || !system.find("", metric)) continue;
      systems.push_back(&system);
      break;
    }
  return systems;
}

std::string published_name(const Published& system) { return system.name + " (published)"; }

std::string published_note(const std::vector<const Published*>& systems) {
  std::string text;
  for (const Published* system : systems)
    text += (text.empty() ? "Published, not measured here: " : "; ") + system->name + " (" +
            system->source + ")";
  return text.empty() ? text : text + ".";
}

}  // namespace stillpoint::study
