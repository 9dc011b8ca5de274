#include "tum_recording/pairing.hpp"

#include <algorithm>
#include <cmath>
#include <queue>
#include <tuple>

namespace stillpoint::tum_recording {
namespace {

/// All stamps in order of time, as a linked list from which pairs are taken out. What lies between
/// a colour and a depth stamp is closer to one of the two than they are to each other, so that the
/// closest pair is always made of neighbours: O(n log n) whatever the allowed difference.
class Timeline {
 public:
  Timeline(std::span<const double> color, std::span<const double> depth, double max_difference)
      : max_difference_(max_difference) {
    for (std::size_t i = 0; i < color.size(); ++i) stamps_.push_back({color[i], false, i});
    for (std::size_t i = 0; i < depth.size(); ++i) stamps_.push_back({depth[i], true, i});
    std::sort(stamps_.begin(), stamps_.end(), [](const Stamp& a, const Stamp& b) {
      return std::tie(a.time, a.is_depth) < std::tie(b.time, b.is_depth);
    });
    for (std::size_t i = 0; i < stamps_.size(); ++i) {
      stamps_[i].previous = i == 0 ? kEnd : i - 1;
      stamps_[i].next = i + 1 == stamps_.size() ? kEnd : i + 1;
      if (i > 0) offer(i - 1, i);
    }
  }

  std::vector<IndexPair> take_closest_first() {
    std::vector<IndexPair> pairs;
    for (; !candidates_.empty(); candidates_.pop()) {
      const Candidate best = candidates_.top();
      if (stamps_[best.left].taken || stamps_[best.right].taken) continue;
      pairs.push_back(best.pair);
      take(best.left);
      take(best.right);
      offer(stamps_[best.left].previous, stamps_[best.right].next);
    }
    return pairs;
  }

 private:
  static constexpr std::size_t kEnd = static_cast<std::size_t>(-1);

  struct Stamp {
    double time;
    bool is_depth;
    std::size_t index;  // in its own list
    bool taken = false;
    std::size_t previous = kEnd;
    std::size_t next = kEnd;
  };

  struct Candidate {
    double difference;
    IndexPair pair;
    std::size_t left;
    std::size_t right;
    bool operator<(const Candidate& other) const {  // the top of the queue is the best
      return std::tie(difference, pair.color, pair.depth) >
             std::tie(other.difference, other.pair.color, other.pair.depth);
    }
  };

  void offer(std::size_t left, std::size_t right) {
    if (left == kEnd || right == kEnd) return;
    const Stamp& a = stamps_[left];
    const Stamp& b = stamps_[right];
    const double difference = std::abs(a.time - b.time);
    if (a.is_depth == b.is_depth || !(difference < max_difference_)) return;
    const IndexPair pair = a.is_depth ? IndexPair{b.index, a.index} : IndexPair{a.index, b.index};
    candidates_.push({difference, pair, left, right});
  }

  void take(std::size_t i) {
    stamps_[i].taken = true;
    if (stamps_[i].previous != kEnd) stamps_[stamps_[i].previous].next = stamps_[i].next;
    if (stamps_[i].next != kEnd) stamps_[stamps_[i].next].previous = stamps_[i].previous;
  }

  double max_difference_;
  std::vector<Stamp> stamps_;
  std::priority_queue<Candidate> candidates_;
};

}  // namespace

std::vector<IndexPair> pair_by_time(std::span<const double> color, std::span<const double> depth,
                                    double max_difference) {
  auto pairs = Timeline(color, depth, max_difference).take_closest_first();
  std::sort(pairs.begin(), pairs.end(),
            [](const IndexPair& a, const IndexPair& b) { return a.color < b.color; });
  return pairs;
}

}  // namespace stillpoint::tum_recording
