#include "study/signed_rank.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <cmath>
#include <numeric>

namespace stillpoint::study {
namespace {

constexpr std::size_t kMostExactPairs = 50;

/// Ranks of sizes, doubled: mean ranks of equal sizes are whole numbers then.
std::vector<int> doubled_ranks(const std::vector<double>& sizes) {
  std::vector<std::size_t> order(sizes.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t i) { return sizes[i]; });
  std::vector<int> ranks(sizes.size());
  for (std::size_t first = 0, end = 0; first < order.size(); first = end) {
    while (end < order.size() && sizes[order[end]] == sizes[order[first]]) ++end;
    for (std::size_t k = first; k < end; ++k)
      ranks[order[k]] = static_cast<int>(first + 1 + end);  // twice the mean of first + 1 … end
  }
  return ranks;
}

/// Twice the chance of a rank sum at least as far out as `sum`, all choices of signs being as
/// likely.
double exact_p(const std::vector<int>& ranks, int sum) {
  const int total = std::accumulate(ranks.begin(), ranks.end(), 0);
  std::vector<double> ways(static_cast<std::size_t>(total) + 1, 0.0);  // to choose ranks of a sum
  ways[0] = 1.0;
  for (const int rank : ranks)
    for (int s = total; s >= rank; --s)
      ways[static_cast<std::size_t>(s)] += ways[static_cast<std::size_t>(s - rank)];
  const int low = std::min(sum, total - sum);
  const double tail = std::accumulate(ways.begin(), ways.begin() + low + 1, 0.0);
  return std::min(1.0, 2.0 * tail / std::exp2(static_cast<double>(ranks.size())));
}

/// With half a (doubled) rank of continuity correction. The variance of a sum of independent signs
/// is a quarter of the sum of squares, ties included.
double approximate_p(const std::vector<int>& ranks, int sum) {
  double mean = 0.0, variance = 0.0;
  for (const int rank : ranks) {
    mean += 0.5 * rank;
    variance += 0.25 * rank * rank;
  }
  const double distance = std::max(0.0, std::abs(sum - mean) - 1.0);
  const boost::math::normal normal;
  return 2.0 * boost::math::cdf(boost::math::complement(normal, distance / std::sqrt(variance)));
}

}  // namespace

SignedRank signed_rank(std::span<const double> differences) {
  std::vector<double> sizes;
  std::vector<bool> positive;
  for (const double difference : differences) {
    if (difference == 0.0) continue;
    sizes.push_back(std::abs(difference));
    positive.push_back(difference > 0.0);
  }
  SignedRank result{.pairs = sizes.size()};
  if (sizes.empty()) return result;
  const std::vector<int> ranks = doubled_ranks(sizes);
  int sum = 0, total = 0;
  for (std::size_t i = 0; i < ranks.size(); ++i) {
    total += ranks[i];
    if (positive[i]) sum += ranks[i];
  }
  result.effect = (2.0 * sum - total) / total;
  result.p = ranks.size() <= kMostExactPairs ? exact_p(ranks, sum) : approximate_p(ranks, sum);
  return result;
}

double smallest_p(std::size_t pairs) {
  return std::min(1.0, std::exp2(1.0 - static_cast<double>(pairs)));
}

std::vector<double> corrected_for_number(std::span<const double> p_values) {
  std::vector<std::size_t> order(p_values.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, {}, [&](std::size_t i) { return p_values[i]; });
  std::vector<double> corrected(p_values.size());
  double largest = 0.0;
  for (std::size_t k = 0; k < order.size(); ++k) {
    const double p = p_values[order[k]] * static_cast<double>(order.size() - k);
    largest = std::max(largest, std::min(1.0, p));
    corrected[order[k]] = largest;
  }
  return corrected;
}

}  // namespace stillpoint::study
