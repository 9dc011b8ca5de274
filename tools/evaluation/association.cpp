#include "evaluation/association.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace stillpoint::evaluation {
namespace {

struct Candidate {
  double difference;
  TimePair pair;
};

std::vector<Candidate> candidates(std::span<const double> first, std::span<const double> second,
                                  double max_difference, double offset) {
  std::vector<Candidate> result;
  std::size_t window_begin = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    while (window_begin < second.size() &&
           second[window_begin] + offset <= first[i] - 2 * max_difference)
      ++window_begin;  // twice the window: rounding must not decide here
    for (std::size_t j = window_begin; j < second.size(); ++j) {
      if (second[j] + offset >= first[i] + 2 * max_difference) break;
      const double difference = std::abs(first[i] - (second[j] + offset));
      if (difference < max_difference) result.push_back({difference, {i, j}});
    }
  }
  return result;
}

}  // namespace

std::vector<TimePair> associate(std::span<const double> first, std::span<const double> second,
                                double max_difference, double offset) {
  std::vector<Candidate> sorted = candidates(first, second, max_difference, offset);
  std::sort(sorted.begin(), sorted.end(), [](const Candidate& a, const Candidate& b) {
    return std::tie(a.difference, a.pair.first, a.pair.second) <
           std::tie(b.difference, b.pair.first, b.pair.second);
  });
  std::vector<bool> first_taken(first.size()), second_taken(second.size());
  std::vector<TimePair> pairs;
  for (const auto& [difference, pair] : sorted) {
    if (first_taken[pair.first] || second_taken[pair.second]) continue;
    first_taken[pair.first] = second_taken[pair.second] = true;
    pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const TimePair& a, const TimePair& b) { return a.first < b.first; });
  return pairs;
}

std::size_t closest(std::span<const double> rising, double value) {
  std::size_t best = 0, begin = 0, end = rising.size();
  while (begin < end) {
    const std::size_t middle = begin + (end - begin) / 2;
    if (std::abs(rising[middle] - value) < std::abs(rising[best] - value)) best = middle;
    if (rising[middle] < value)
      begin = middle + 1;
    else
      end = middle;
  }
  return best;
}

}  // namespace stillpoint::evaluation
