#include "report/worst_moments.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "evaluation/format.hpp"

namespace stillpoint::report {
namespace {

using evaluation::fixed;

constexpr std::size_t kMostOfAKind = 3;
constexpr double kApart = 1.0;  // seconds

const FrameRow& row_at(const RunData& run, double seconds) {
  return *std::ranges::min_element(
      run.frame_rows, {}, [&](const FrameRow& row) { return std::abs(row.seconds - seconds); });
}

/// Something that may have been bad: how much, when, and as text.
struct Candidate {
  double badness = 0;
  double seconds = 0;
  std::string value;
};

/// `worst` and `bad` say what its value is.
void add_worst(const RunData& run, std::vector<Candidate> candidates, const std::string& worst,
               const std::string& bad, std::vector<WorstMoment>& moments) {
  std::ranges::stable_sort(candidates, std::greater(), &Candidate::badness);
  std::vector<double> taken;
  for (const Candidate& candidate : candidates) {
    if (taken.size() == kMostOfAKind) return;
    const auto is_near = [&](double seconds) {
      return std::abs(seconds - candidate.seconds) < kApart;
    };
    if (std::ranges::any_of(taken, is_near)) continue;
    moments.push_back({.frame = row_at(run, candidate.seconds).frame,
                       .why = (taken.empty() ? worst : bad) + candidate.value,
                       .first = taken.empty()});
    taken.push_back(candidate.seconds);
  }
}

std::vector<Candidate> losses(const RunData& run) {
  std::vector<Candidate> candidates;
  for (const Interval& stretch : run.lost)
    candidates.push_back({.badness = -stretch.begin,
                          .seconds = stretch.begin,
                          .value = fixed(stretch.begin, 2) + " s"});
  return candidates;
}

std::vector<Candidate> errors(const RunData& run) {
  std::vector<Candidate> candidates;
  for (const TracePoint& point : run.trace)
    candidates.push_back({.badness = point.error_m,
                          .seconds = point.seconds,
                          .value = fixed(1000 * point.error_m, 1) + " mm"});
  return candidates;
}

std::vector<Candidate> exclusions(const RunData& run) {
  std::vector<Candidate> candidates;
  for (const FrameRow& row : run.frame_rows)
    if (row.excluded > 0.0)
      candidates.push_back({.badness = row.excluded,
                            .seconds = row.seconds,
                            .value = fixed(100 * row.excluded, 1) + " %"});
  return candidates;
}

std::vector<Candidate> lacks_of_inliers(const RunData& run) {
  std::vector<Candidate> candidates;
  for (const FrameRow& row : run.frame_rows)
    if (row.tracked && row.matches > 0)
      candidates.push_back({.badness = -static_cast<double>(row.inliers),
                            .seconds = row.seconds,
                            .value = std::to_string(row.inliers)});
  return candidates;
}

}  // namespace

std::vector<WorstMoment> worst_moments(const RunData& run) {
  std::vector<WorstMoment> moments;
  if (run.frame_rows.empty()) return moments;
  add_worst(run, losses(run), "lost at ", "lost at ", moments);
  add_worst(run, errors(run), "largest error: ", "large error: ", moments);
  add_worst(run, exclusions(run), "most excluded: ", "much excluded: ", moments);
  add_worst(run, lacks_of_inliers(run), "fewest inliers: ", "few inliers: ", moments);
  return moments;
}

}  // namespace stillpoint::report
