// Finds the features near a pixel.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "stillpoint/contracts/camera.hpp"
#include "stillpoint/contracts/features.hpp"

namespace stillpoint::orb_slam {

/// Buckets of the feature indices of one image. Building it takes microseconds, so it is made where
/// it is needed and not kept.
class FeatureGrid {
 public:
  FeatureGrid() = default;
  FeatureGrid(const Features& features, const Camera& camera);

  /// Calls `visit(index)` for every feature in the square of half-width `radius` px around (u, v).
  template <class Visit>
  void for_each_near(double u, double v, double radius, Visit visit) const {
    const int first_column = column(u - radius), last_column = column(u + radius);
    const int last_row = row(v + radius);
    for (int r = row(v - radius); r <= last_row; ++r) {
      const std::uint32_t begin = start_[r * columns_ + first_column];
      const std::uint32_t end = start_[r * columns_ + last_column + 1];
      for (std::uint32_t i = begin; i < end; ++i)
        if (std::abs(entries_[i].u - u) <= radius && std::abs(entries_[i].v - v) <= radius)
          visit(entries_[i].index);
    }
  }

 private:
  static constexpr int kCell = 10;  // px

  struct Entry {
    float u, v;
    std::uint32_t index;
  };

  int column(double u) const { return std::clamp(static_cast<int>(u) / kCell, 0, columns_ - 1); }
  int row(double v) const { return std::clamp(static_cast<int>(v) / kCell, 0, rows_ - 1); }

  int columns_ = 1;
  int rows_ = 1;
  std::vector<std::uint32_t> start_ = {0, 0};  // first entry of each cell, row by row
  std::vector<Entry> entries_;                 // sorted by cell
};

}  // namespace stillpoint::orb_slam
