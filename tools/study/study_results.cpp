#include "study/study_results.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "evaluation/best.hpp"

namespace stillpoint::study {
namespace {

template <class Named>
std::optional<std::size_t> index_of(const std::vector<Named>& list, const std::string& name) {
  const auto found = std::ranges::find(list, name, &Named::name);
  if (found == list.end()) return std::nullopt;
  return static_cast<std::size_t>(found - list.begin());
}

/// Nothing when one is missing or there is nothing to divide by.
std::optional<double> ratio(const std::optional<Spread>& of, const std::optional<Spread>& to) {
  if (!of || !to || to->median <= 0.0) return std::nullopt;
  return of->median / to->median;
}

}  // namespace

std::optional<Spread> spread_of(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  std::ranges::sort(values);
  const std::size_t n = values.size();
  const auto quantile = [&](double share) {
    const double at = share * static_cast<double>(n - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, n - 1);
    return std::lerp(values[below], values[above], at - static_cast<double>(below));
  };
  return Spread{.median = quantile(0.5),
                .first_quartile = quantile(0.25),
                .third_quartile = quantile(0.75),
                .min = values.front(),
                .max = values.back(),
                .count = n};
}

std::pair<std::size_t, std::size_t> StudyResults::cells_of(std::size_t sequence,
                                                           std::size_t variant) const {
  const auto first = std::ranges::lower_bound(cells, Cell{sequence, variant, 0});
  const auto last = std::ranges::lower_bound(first, cells.end(), Cell{sequence, variant + 1, 0});
  return {static_cast<std::size_t>(first - cells.begin()),
          static_cast<std::size_t>(last - cells.begin())};
}

std::optional<Spread> StudyResults::spread(std::size_t sequence, std::size_t variant,
                                           MetricId metric) const {
  std::vector<double> values;
  const auto [first, last] = cells_of(sequence, variant);
  for (std::size_t i = first; i < last; ++i)
    if (results[i] && results[i]->values[metric]) values.push_back(*results[i]->values[metric]);
  return spread_of(std::move(values));
}

std::optional<Spread> StudyResults::spread(std::size_t variant, MetricId metric) const {
  std::vector<double> values;
  for (std::size_t sequence = 0; sequence < study.sequences.size(); ++sequence) {
    const auto [first, last] = cells_of(sequence, variant);
    for (std::size_t i = first; i < last; ++i)
      if (results[i] && results[i]->values[metric]) values.push_back(*results[i]->values[metric]);
  }
  return spread_of(std::move(values));
}

std::optional<Spread> StudyResults::spread(MetricId metric) const {
  std::vector<double> values;
  for (const std::optional<CellResult>& result : results)
    if (result && result->values[metric]) values.push_back(*result->values[metric]);
  return spread_of(std::move(values));
}

const CellResult* StudyResults::find(const Cell& cell) const {
  const auto found = std::ranges::lower_bound(cells, cell);
  if (found == cells.end() || *found != cell) return nullptr;
  const std::optional<CellResult>& result =
      results[static_cast<std::size_t>(found - cells.begin())];
  return result ? &*result : nullptr;
}

std::size_t StudyResults::failed() const {
  return static_cast<std::size_t>(
      std::ranges::count_if(results, [](const auto& r) { return r && r->failed(); }));
}

std::size_t StudyResults::missing() const {
  return static_cast<std::size_t>(std::ranges::count_if(results, [](const auto& r) { return !r; }));
}

std::pair<std::size_t, std::size_t> StudyResults::without_result(std::size_t sequence,
                                                                 std::size_t variant) const {
  std::size_t failed = 0, missing = 0;
  const auto [first, last] = cells_of(sequence, variant);
  for (std::size_t i = first; i < last; ++i) {
    missing += results[i] ? 0 : 1;
    failed += results[i] && results[i]->failed() ? 1 : 0;
  }
  return {failed, missing};
}

bool StudyResults::all_failed(std::size_t sequence, std::size_t variant) const {
  return without_result(sequence, variant).first == static_cast<std::size_t>(study.repeats);
}

std::optional<std::size_t> empty_scene_of(const Study& study, std::size_t sequence) {
  const Sequence& own = study.sequences[sequence];
  return index_of(study.sequences, own.empty_scene.empty() ? own.name + "_empty" : own.empty_scene);
}

bool is_empty_scene(const Study& study, std::size_t sequence) {
  for (std::size_t other = 0; other < study.sequences.size(); ++other)
    if (empty_scene_of(study, other) == sequence) return true;
  return false;
}

std::optional<double> dynamic_penalty(const StudyResults& results, std::size_t sequence,
                                      std::size_t variant) {
  const auto empty = empty_scene_of(results.study, sequence);
  if (!empty) return std::nullopt;
  return ratio(results.spread(sequence, variant, kAte), results.spread(*empty, variant, kAte));
}

std::optional<std::size_t> baseline_of(const Study& study) {
  return index_of(study.variants, study.baseline);
}

std::optional<Spread> improvement_percent(const StudyResults& results, std::size_t sequence,
                                          std::size_t variant) {
  const auto baseline = baseline_of(results.study);
  if (!baseline || *baseline == variant) return std::nullopt;
  std::vector<double> improvements;
  for (int repeat = 0; repeat < results.study.repeats; ++repeat) {
    const CellResult* own = results.find({sequence, variant, repeat});
    const CellResult* other = results.find({sequence, *baseline, repeat});
    if (own && other && own->values[kAte] && other->values[kAte].value_or(0.0) > 0.0)
      improvements.push_back(100.0 * (1.0 - *own->values[kAte] / *other->values[kAte]));
  }
  return spread_of(std::move(improvements));
}

namespace {

/// Of the runs of the variant, the share that failed, lost tracking or have no error.
double share_in_trouble(const StudyResults& results, std::size_t sequence, std::size_t variant) {
  const auto [first, last] = results.cells_of(sequence, variant);
  int runs = 0, troubles = 0;
  for (std::size_t i = first; i < last; ++i) {
    const std::optional<CellResult>& result = results.results[i];
    if (!result) continue;
    ++runs;
    troubles +=
        result->failed() || !result->values[kAte] || result->values[kTimesLost].value_or(0.0) > 0.0;
  }
  return runs > 0 ? static_cast<double>(troubles) / runs : 0.0;
}

/// Where others have fewer, the median of the runs that went well is not comparable with theirs.
void leave_out_those_in_trouble(const StudyResults& results, std::size_t sequence,
                                std::vector<std::optional<evaluation::RatedFigure>>& figures) {
  std::vector<double> shares(figures.size(), 1.0);
  for (std::size_t variant = 0; variant < figures.size(); ++variant)
    if (figures[variant]) shares[variant] = share_in_trouble(results, sequence, variant);
  const double least = std::ranges::min(shares);
  for (std::size_t variant = 0; variant < figures.size(); ++variant)
    if (figures[variant]) figures[variant]->can_win = shares[variant] <= least;
}

}  // namespace

std::vector<bool> best_variants(const StudyResults& results, std::size_t sequence,
                                MetricId metric) {
  const Metric& m = metrics()[metric];
  std::vector<std::optional<evaluation::RatedFigure>> figures(results.study.variants.size());
  for (std::size_t variant = 0; variant < figures.size(); ++variant) {
    const auto spread = results.spread(sequence, variant, metric);
    if (!spread) continue;
    figures[variant] = {.value = spread->median};
    const auto coverage = results.spread(sequence, variant, kCoverage);
    if (m.is_pose_error) figures[variant]->coverage_percent = coverage ? coverage->median : 0.0;
  }
  if (m.is_pose_error && !figures.empty()) leave_out_those_in_trouble(results, sequence, figures);
  return best_of(figures, m.better, m.digits);
}

std::string among_comparable() {
  return ", among those that cover the same up to 1 % and failed or lost tracking as rarely as "
         "any.";
}

}  // namespace stillpoint::study
