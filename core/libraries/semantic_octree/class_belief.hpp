// Which class a voxel has.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

namespace stillpoint::semantic_octree {

/// Dirichlet counts of the few classes seen most: the expected probability of a class is its count
/// over their sum. Old observations fade once a count is full. 6 bytes, as every voxel has one.
class ClassBelief {
 public:
  static constexpr int kClasses = 3;

  /// One more observation of a class, by its id. A class that is not among the best replaces the
  /// weakest and takes over its count (Metwally et al., Efficient Computation of Frequent and Top-k
  /// Elements in Data Streams, ICDT 2005), so that no frequent class is ever left out.
  void add(std::uint8_t label) {
    int place = 0;
    while (place < kClasses && counts_[place] > 0 && labels_[place] != label) ++place;
    if (place == kClasses) --place;
    labels_[place] = label;
    if (++counts_[place] == kFull)
      for (std::uint8_t& count : counts_) count /= 2;
    for (; place > 0 && counts_[place] >= counts_[place - 1]; --place) {
      std::swap(counts_[place], counts_[place - 1]);
      std::swap(labels_[place], labels_[place - 1]);
    }
  }

  /// One that has this best class and, but for rounding, its probability in 1/255: what files keep.
  static ClassBelief of(std::uint8_t label, std::uint8_t confidence) {
    ClassBelief belief;
    if (confidence == 0) return belief;
    const int rest = 255 - confidence;
    belief.labels_[0] = label;
    belief.counts_ = {std::min(confidence, static_cast<std::uint8_t>(kFull - 1)),
                      static_cast<std::uint8_t>(rest - rest / 2),
                      static_cast<std::uint8_t>(rest / 2)};
    return belief;
  }

  bool known() const { return counts_[0] > 0; }
  /// The most probable class; 0 when nothing is known. Of equals, the one seen last.
  std::uint8_t best() const { return labels_[0]; }
  /// Its expected probability; 0 when nothing is known.
  double confidence() const {
    int sum = 0;
    for (const std::uint8_t count : counts_) sum += count;
    return sum > 0 ? static_cast<double>(counts_[0]) / sum : 0.0;
  }

  bool operator==(const ClassBelief&) const = default;

 private:
  static constexpr std::uint8_t kFull = 255;

  std::array<std::uint8_t, kClasses> labels_{};  // in order of their counts, largest first
  std::array<std::uint8_t, kClasses> counts_{};
};

}  // namespace stillpoint::semantic_octree
