// Place recognition without a trained vocabulary: a word is a run of 16 bits of a
// descriptor, as in multi-index hashing (Norouzi, Punjani and Fleet, CVPR 2012). Descriptors that
// share a word are compared in full, so that a vote is a likely correspondence.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "orb_slam/matcher.hpp"
#include "stillpoint/contracts/features.hpp"
#include "stillpoint/contracts/sparse_map.hpp"

namespace stillpoint::orb_slam {

struct PlaceVote {
  KeyFrameId keyframe = kNoId;
  /// Sum over the descriptors of the view that the key frame shows, each weighted by how few key
  /// frames show it (inverse document frequency).
  double score = 0.0;
};

/// The descriptors that represent a place: those of the strongest usable features.
std::vector<Descriptor> place_descriptors(const Features& features, const FeatureFilter& usable);
/// Those of a key frame: of features on landmarks.
std::vector<Descriptor> place_descriptors(const KeyFrame& keyframe);

/// Grows with the key frames of a map, 40 kB each. One object per thread.
class PlaceIndex {
 public:
  PlaceIndex();

  /// Adds key frames of `map` that are not in the index, at most `most`, the oldest first, and
  /// drops those that were removed from the map.
  void update(const SparseMap& map, std::size_t most = std::numeric_limits<std::size_t>::max());

  /// Key frames with votes, best first; equal scores by id.
  std::vector<PlaceVote> query(std::span<const Descriptor> view) const;

  std::size_t size() const { return keyframe_count_; }

 private:
  struct Entry {
    Descriptor descriptor;
    KeyFrameId keyframe;
  };
  using Word = std::uint16_t;
  static constexpr int kTables = 8;

  void add(const KeyFrame& keyframe);
  void purge_removed(const SparseMap& map);
  void post(std::uint32_t entry);
  static Word word(const Descriptor& descriptor, int table);
  std::vector<std::uint32_t>& bucket(int table, Word word) {
    return buckets_[static_cast<std::size_t>(table) << 16 | word];
  }
  const std::vector<std::uint32_t>& bucket(int table, Word word) const {
    return buckets_[static_cast<std::size_t>(table) << 16 | word];
  }

  std::vector<Entry> entries_;
  std::vector<std::vector<std::uint32_t>> buckets_;  // entries by table and word
  std::vector<bool> present_;                        // by key frame id
  std::size_t keyframe_count_ = 0;
};

}  // namespace stillpoint::orb_slam
