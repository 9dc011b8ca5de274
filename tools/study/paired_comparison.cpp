#include "study/paired_comparison.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "evaluation/best.hpp"
#include "study/signed_rank.hpp"

namespace stillpoint::study {
namespace {

constexpr double kDecided = std::numeric_limits<double>::infinity();

double coverage_of(const CellResult& result) {
  return result.failed() || !result.values[kAte] ? 0.0 : result.values[kCoverage].value_or(0.0);
}

bool was_lost(const CellResult& result) { return result.values[kTimesLost].value_or(0.0) > 0.0; }

/// log(ATE of the baseline ÷ ATE of the variant): positive where the variant is better; infinite
/// where the runs have not covered the same. Nothing where neither has an error.
std::optional<double> advantage(const CellResult& variant, const CellResult& baseline) {
  const double more = coverage_of(variant) - coverage_of(baseline);
  if (std::abs(more) > evaluation::kSameCoveragePercent) return more > 0.0 ? kDecided : -kDecided;
  if (!variant.values[kAte] || !baseline.values[kAte]) return std::nullopt;
  if (was_lost(variant) != was_lost(baseline)) return was_lost(variant) ? -kDecided : kDecided;
  return std::log(*baseline.values[kAte] / *variant.values[kAte]);
}

/// Of one recording.
struct Pair {
  double advantage = 0.0;
  bool by_coverage = false;  // decided by it, not by errors
  std::optional<double> time_ratio;
};

/// The same whichever of the two is called the baseline. Not a number: two opposite decisions.
double median(std::vector<double> values) {
  std::ranges::sort(values);
  return (values[(values.size() - 1) / 2] + values[values.size() / 2]) / 2.0;
}

class Pairs {
 public:
  Pairs(const StudyResults& results, std::size_t variant, std::size_t baseline)
      : results_(results), variant_(variant), baseline_(baseline) {}

  std::vector<Pair> all() const {
    std::vector<Pair> pairs;
    for (const std::vector<std::size_t>& sequences : recordings())
      if (const auto pair = of_recording(sequences)) pairs.push_back(*pair);
    return pairs;
  }

 private:
  /// Sequences that have the same images are one recording.
  std::vector<std::vector<std::size_t>> recordings() const {
    const std::vector<Sequence>& all = results_.study.sequences;
    std::vector<std::vector<std::size_t>> groups;
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (is_empty_scene(results_.study, i)) continue;
      const auto same = std::ranges::find_if(
          groups, [&](const auto& group) { return same_images(all[group.front()], all[i]); });
      if (same == groups.end())
        groups.push_back({i});
      else
        same->push_back(i);
    }
    return groups;
  }

  std::optional<Pair> of_recording(const std::vector<std::size_t>& sequences) const {
    std::vector<double> advantages, times;
    for (const std::size_t sequence : sequences)
      for (int repeat = 0; repeat < results_.study.repeats; ++repeat) {
        const CellResult* own = results_.find({sequence, variant_, repeat});
        const CellResult* other = results_.find({sequence, baseline_, repeat});
        if (!own || !other) continue;
        if (const auto value = advantage(*own, *other)) advantages.push_back(*value);
        const auto &time = own->values[kCpuPerFrame], &other_time = other->values[kCpuPerFrame];
        if (time && other_time && *other_time > 0.0) times.push_back(*time / *other_time);
      }
    if (advantages.empty()) return std::nullopt;
    const double middle = median(std::move(advantages));
    Pair pair{.advantage = std::isnan(middle) ? 0.0 : middle,
              .by_coverage = !std::isfinite(middle),
              .time_ratio = {}};
    if (const auto spread = spread_of(std::move(times))) pair.time_ratio = spread->median;
    return pair;
  }

  const StudyResults& results_;
  const std::size_t variant_, baseline_;
};

PairedComparison comparison_of(std::size_t variant, const std::vector<Pair>& pairs) {
  PairedComparison result{
      .variant = variant, .recordings = pairs.size(), .ate_ratio = {}, .time_ratio = {}};
  std::vector<double> advantages, ratios, times;
  for (const Pair& pair : pairs) {
    advantages.push_back(pair.advantage);
    result.better += pair.advantage > 0.0;
    result.worse += pair.advantage < 0.0;
    if (pair.by_coverage)
      ++result.incomplete;
    else
      ratios.push_back(std::exp(-pair.advantage));
    if (pair.time_ratio) times.push_back(*pair.time_ratio);
  }
  result.ate_ratio = spread_of(std::move(ratios));
  result.time_ratio = spread_of(std::move(times));
  const SignedRank test = signed_rank(advantages);
  result.effect = test.effect;
  result.p = test.p;
  return result;
}

/// Each corrected p grows with every p: the smallest are those of the smallest.
void correct_for_number(std::vector<PairedComparison>& comparisons) {
  std::vector<double> p_values, smallest;
  for (const PairedComparison& one : comparisons) {
    p_values.push_back(one.p);
    smallest.push_back(smallest_p(one.recordings));
  }
  const std::vector<double> corrected = corrected_for_number(p_values);
  const std::vector<double> least = corrected_for_number(smallest);
  for (std::size_t i = 0; i < comparisons.size(); ++i) {
    comparisons[i].corrected_p = corrected[i];
    comparisons[i].least_p = least[i];
  }
}

}  // namespace

std::vector<PairedComparison> compare_with_baseline(const StudyResults& results) {
  std::vector<PairedComparison> comparisons;
  const std::vector<Variant>& variants = results.study.variants;
  const auto baseline = baseline_of(results.study);
  if (!baseline) return comparisons;
  for (std::size_t variant = 0; variant < variants.size(); ++variant) {
    if (variant == *baseline) continue;
    const std::vector<Pair> pairs = Pairs(results, variant, *baseline).all();
    if (!pairs.empty()) comparisons.push_back(comparison_of(variant, pairs));
  }
  correct_for_number(comparisons);
  return comparisons;
}

std::string significance_note(const Study& study,
                              const std::vector<PairedComparison>& comparisons) {
  if (std::ranges::none_of(comparisons, &PairedComparison::is_significant)) return "";
  return "†: differs from " + study.baseline +
         " (signed-rank test across recordings, corrected p < 0.05).";
}

std::string left_out_note(const Study& study) {
  for (std::size_t sequence = 0; sequence < study.sequences.size(); ++sequence)
    if (is_empty_scene(study, sequence))
      return "Empty scenes, which the dynamic penalty is measured with, take no part.";
  return "";
}

std::string recordings_note(const std::vector<PairedComparison>& comparisons) {
  if (std::ranges::all_of(comparisons, &PairedComparison::can_be_significant)) return "";
  const std::size_t count = comparisons.size();
  std::size_t needed = 1;
  while (static_cast<double>(count) * smallest_p(needed) >= kSignificance) ++needed;
  return "At least: the smallest p that so few recordings can give, however large the difference; "
         "with " +
         std::to_string(count) + (count == 1 ? " comparison" : " comparisons") + ", it takes " +
         std::to_string(needed) + " recordings to come below 0.05.";
}

}  // namespace stillpoint::study
