#include "orb_slam/place_index.hpp"

#include <algorithm>
#include <cmath>

#include "orb_slam/orb_keyframe.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr std::size_t kDescriptors = 500;  // of a key frame
constexpr int kMaxWordDistance = 40;       // Hamming
// Words with more entries are not distinctive and would take nearly all of the time.
constexpr double kMaxEntries = 24;
constexpr double kMaxEntriesPerKeyFrame = 0.01;

}  // namespace

std::vector<Descriptor> place_descriptors(const Features& features, const FeatureFilter& usable) {
  std::vector<std::uint32_t> chosen;
  for (std::uint32_t i = 0; i < features.size(); ++i)
    if (usable(i)) chosen.push_back(i);
  std::ranges::stable_sort(chosen, std::greater(),
                           [&](std::uint32_t i) { return features.keypoints[i].response; });
  chosen.resize(std::min(chosen.size(), kDescriptors));
  std::vector<Descriptor> descriptors;
  for (const std::uint32_t i : chosen) descriptors.push_back(features.descriptors[i]);
  return descriptors;
}

std::vector<Descriptor> place_descriptors(const KeyFrame& keyframe) {
  require_orb(keyframe);
  return place_descriptors(*keyframe.features,
                           [&](std::uint32_t i) { return keyframe.landmarks[i] != kNoId; });
}

PlaceIndex::PlaceIndex() : buckets_(static_cast<std::size_t>(kTables) << 16) {}

void PlaceIndex::update(const SparseMap& map, std::size_t most) {
  purge_removed(map);
  while (present_.size() < map.keyframe_id_end() && most > 0) {
    const KeyFrame* keyframe = map.keyframe(static_cast<KeyFrameId>(present_.size()));
    present_.push_back(keyframe != nullptr);
    if (!keyframe) continue;
    add(*keyframe);
    --most;
  }
}

void PlaceIndex::add(const KeyFrame& keyframe) {
  ++keyframe_count_;
  for (const Descriptor& descriptor : place_descriptors(keyframe)) {
    entries_.push_back({descriptor, keyframe.id});
    post(static_cast<std::uint32_t>(entries_.size() - 1));
  }
}

// Entries of removed key frames stay until they may be half of all: removal rebuilds the index.
void PlaceIndex::purge_removed(const SparseMap& map) {
  for (KeyFrameId id = 0; id < present_.size(); ++id) {
    if (!present_[id] || map.keyframe(id)) continue;
    present_[id] = false;
    --keyframe_count_;
  }
  if (entries_.size() <= 2 * kDescriptors * (keyframe_count_ + 1)) return;
  std::erase_if(entries_, [&](const Entry& entry) { return !present_[entry.keyframe]; });
  for (auto& bucket : buckets_) bucket.clear();
  for (std::uint32_t i = 0; i < entries_.size(); ++i) post(i);
}

void PlaceIndex::post(std::uint32_t entry) {
  for (int table = 0; table < kTables; ++table)
    bucket(table, word(entries_[entry].descriptor, table)).push_back(entry);
}

std::vector<PlaceVote> PlaceIndex::query(std::span<const Descriptor> view) const {
  std::vector<double> scores(present_.size());
  std::vector<std::size_t> voted(present_.size());  // by which descriptor last, from 1
  std::vector<KeyFrameId> shown_by;
  const double all = static_cast<double>(keyframe_count_) + 1;
  const double most = kMaxEntries + kMaxEntriesPerKeyFrame * all;
  for (std::size_t i = 0; i < view.size(); ++i) {
    shown_by.clear();
    for (int table = 0; table < kTables; ++table) {
      const auto& entries = bucket(table, word(view[i], table));
      if (static_cast<double>(entries.size()) > most) continue;
      for (const std::uint32_t e : entries) {
        const KeyFrameId id = entries_[e].keyframe;
        if (!present_[id] || voted[id] == i + 1) continue;
        if (hamming_distance(entries_[e].descriptor, view[i]) > kMaxWordDistance) continue;
        voted[id] = i + 1;
        shown_by.push_back(id);
      }
    }
    const double weight =
        shown_by.empty() ? 0 : std::log(all / static_cast<double>(shown_by.size()));
    for (const KeyFrameId id : shown_by) scores[id] += weight;
  }
  std::vector<PlaceVote> votes;
  for (KeyFrameId id = 0; id < scores.size(); ++id)
    if (scores[id] > 0) votes.push_back({id, scores[id]});
  std::ranges::stable_sort(votes, std::greater(), &PlaceVote::score);
  return votes;
}

// Consecutive tests of a descriptor are independent, so that any 16 bits serve as a word.
PlaceIndex::Word PlaceIndex::word(const Descriptor& descriptor, int table) {
  const int first = table * 256 / kTables;
  return static_cast<Word>(descriptor[static_cast<std::size_t>(first) / 64] >> (first % 64));
}

}  // namespace stillpoint::orb_slam
