#include "propagator_flow_depth/object_matching.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::propagator_flow_depth {
namespace {

constexpr double kMinOverlap = 0.3;       // of the smaller mask
constexpr double kMinCovered = 0.5;       // of a followed object
constexpr float kDepthDifference = 0.2f;  // relative

struct Pair {
  std::size_t found;
  std::size_t followed;
  int overlap;  // px
};

/// Pixels by (found + 1, followed + 1), 0 meaning none.
cv::Mat count_pairs(const MatchInput& input) {
  cv::Mat counts(static_cast<int>(input.found.size()) + 1,
                 static_cast<int>(input.followed_ids.size()) + 1, CV_32S, cv::Scalar(0));
  if (input.followed_instances.empty()) return counts;
  for (int y = 0; y < input.found_instances.rows; ++y) {
    const auto* found = input.found_instances.ptr<unsigned char>(y);
    const auto* followed = input.followed_instances.ptr<unsigned char>(y);
    for (int x = 0; x < input.found_instances.cols; ++x)
      if (found[x] || followed[x]) ++counts.at<int>(found[x], followed[x]);
  }
  return counts;
}

bool similar_depth(const DepthLayer& a, const DepthLayer& b) {
  return !a.known() || !b.known() ||
         std::abs(a.middle - b.middle) < kDepthDifference * std::max(a.middle, b.middle);
}

}  // namespace

Matches match_objects(const MatchInput& input) {
  Matches matches{std::vector<int>(input.found.size(), -1),
                  std::vector<bool>(input.followed.size(), false)};
  const cv::Mat counts = count_pairs(input);
  std::vector<Pair> pairs;
  for (std::size_t f = 0; f < input.followed.size(); ++f) {
    const auto place = std::ranges::find(input.followed_ids, input.followed[f].id);
    if (place == input.followed_ids.end()) continue;
    const int column = static_cast<int>(place - input.followed_ids.begin()) + 1;
    const int size = static_cast<int>(cv::sum(counts.col(column))[0]);
    int of_its_class = 0;
    for (std::size_t i = 0; i < input.found.size(); ++i) {
      const int row = static_cast<int>(i) + 1;
      const int overlap = counts.at<int>(row, column);
      if (input.found[i].label != input.followed[f].label || overlap == 0) continue;
      of_its_class += overlap;
      const int smaller = std::min(size, static_cast<int>(cv::sum(counts.row(row))[0]));
      if (overlap >= kMinOverlap * smaller &&
          similar_depth(input.found[i].layer, input.followed[f].layer))
        pairs.push_back({i, f, overlap});
    }
    matches.covered[f] = of_its_class > kMinCovered * size;
  }
  std::ranges::stable_sort(pairs, std::greater{}, &Pair::overlap);
  std::vector<bool> taken(input.followed.size(), false);
  for (const Pair& pair : pairs) {
    if (taken[pair.followed] || matches.followed_of[pair.found] >= 0) continue;
    taken[pair.followed] = true;
    matches.followed_of[pair.found] = static_cast<int>(pair.followed);
  }
  return matches;
}

}  // namespace stillpoint::propagator_flow_depth
