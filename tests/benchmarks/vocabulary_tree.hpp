// A trained vocabulary tree, to compare the place index with: hierarchical k-medians of binary
// descriptors, tf-idf weights and L1 scores (Gálvez-López and Tardós, T-RO 2012).
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <span>
#include <vector>

#include "orb_slam/matcher.hpp"
#include "orb_slam/place_index.hpp"

namespace stillpoint::orb_slam {

class VocabularyTree {
 public:
  VocabularyTree(std::vector<Descriptor> examples, int branches, int levels)
      : branches_(static_cast<std::size_t>(branches)) {
    nodes_.emplace_back();
    grow(0, examples, levels);
  }

  std::size_t words() const { return words_; }
  double megabytes() const { return static_cast<double>(nodes_.size() * sizeof(Node)) / 1e6; }

  std::uint32_t word(const Descriptor& descriptor) const {
    std::uint32_t at = 0;
    while (nodes_[at].child_count > 0) {
      const Node& node = nodes_[at];
      const std::span children(&nodes_[node.first_child], node.child_count);
      at = node.first_child + nearest(children, descriptor);
    }
    return nodes_[at].word;
  }

 private:
  struct Node {
    Descriptor centre{};
    std::uint32_t first_child = 0;
    std::uint32_t child_count = 0;
    std::uint32_t word = 0;  // of a leaf
  };

  static std::uint32_t nearest(std::span<const Node> nodes, const Descriptor& descriptor) {
    const auto distance = [&](const Node& n) { return hamming_distance(n.centre, descriptor); };
    return static_cast<std::uint32_t>(std::ranges::min_element(nodes, {}, distance) -
                                      nodes.begin());
  }

  // Each bit is that of most of the members.
  static Descriptor median(std::span<const Descriptor> members) {
    std::array<std::uint32_t, 256> ones{};
    for (const Descriptor& d : members)
      for (std::size_t bit = 0; bit < 256; ++bit) ones[bit] += d[bit / 64] >> (bit % 64) & 1;
    Descriptor result{};
    for (std::size_t bit = 0; bit < 256; ++bit)
      if (2 * ones[bit] > members.size()) result[bit / 64] |= std::uint64_t{1} << (bit % 64);
    return result;
  }

  void grow(std::uint32_t at, const std::vector<Descriptor>& members, int levels) {
    if (levels == 0 || members.size() <= branches_) {
      nodes_[at].word = words_++;
      return;
    }
    const auto first = static_cast<std::uint32_t>(nodes_.size());
    std::vector<std::vector<Descriptor>> groups = cluster(members);
    nodes_[at].first_child = first;
    nodes_[at].child_count = static_cast<std::uint32_t>(groups.size());
    for (const auto& group : groups) nodes_.push_back({.centre = median(group)});
    for (std::uint32_t i = 0; i < groups.size(); ++i) grow(first + i, groups[i], levels - 1);
  }

  std::vector<std::vector<Descriptor>> cluster(const std::vector<Descriptor>& members) {
    constexpr int kRounds = 6;
    std::vector<Node> centres;
    for (std::size_t i = 0; i < branches_; ++i)
      centres.push_back({.centre = members[random_() % members.size()]});
    std::vector<std::vector<Descriptor>> groups;
    for (int round = 0; round < kRounds; ++round) {
      groups.assign(centres.size(), {});
      for (const Descriptor& d : members) groups[nearest(centres, d)].push_back(d);
      std::erase_if(groups, [](const auto& group) { return group.empty(); });
      centres.clear();
      for (const auto& group : groups) centres.push_back({.centre = median(group)});
    }
    return groups;
  }

  std::size_t branches_;
  std::vector<Node> nodes_;
  std::uint32_t words_ = 0;
  std::mt19937 random_{1};
};

class TreeIndex {
 public:
  explicit TreeIndex(const VocabularyTree& tree) : tree_(tree), shown_by_(tree.words()) {}

  void add(KeyFrameId id, std::span<const Descriptor> view) {
    for (const auto& [word, count] : counts(view)) shown_by_[word].push_back({id, count});
    ++views_;
  }
  /// Once all have been added.
  void finish() {
    totals_.assign(views_, 0.0);
    for (std::uint32_t word = 0; word < shown_by_.size(); ++word)
      for (const Showing& s : shown_by_[word]) totals_[s.keyframe] += s.count * weight(word);
  }

  std::vector<PlaceVote> query(std::span<const Descriptor> view) const {
    const auto mine = counts(view);
    double total = 0;
    for (const auto& [word, count] : mine) total += count * weight(word);
    std::map<KeyFrameId, double> scores;
    for (const auto& [word, count] : mine)
      for (const auto& [id, theirs] : shown_by_[word])
        scores[id] += weight(word) * std::min(count / total, theirs / totals_[id]);
    std::vector<PlaceVote> votes;
    for (const auto& [id, score] : scores) votes.push_back({id, score});
    std::ranges::stable_sort(votes, std::greater(), &PlaceVote::score);
    return votes;
  }

 private:
  struct Showing {
    KeyFrameId keyframe;
    double count;
  };

  std::map<std::uint32_t, double> counts(std::span<const Descriptor> view) const {
    std::map<std::uint32_t, double> result;
    for (const Descriptor& d : view) ++result[tree_.word(d)];
    return result;
  }
  double weight(std::uint32_t word) const {
    const std::size_t count = shown_by_[word].size();
    return count == 0 ? 0 : std::log(static_cast<double>(views_) / static_cast<double>(count));
  }

  const VocabularyTree& tree_;
  std::vector<std::vector<Showing>> shown_by_;
  std::vector<double> totals_;  // by view
  std::size_t views_ = 0;
};

}  // namespace stillpoint::orb_slam
