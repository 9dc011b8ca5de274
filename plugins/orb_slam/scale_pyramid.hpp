// What pyramid levels mean for measurements and distances.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "stillpoint/contracts/features.hpp"
#include "stillpoint/contracts/landmark.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::orb_slam {

/// Factors of the pyramid that features were extracted from.
class ScalePyramid {
 public:
  static constexpr int kMaxLevels = 16;

  /// Throws Error(kStage) for more levels: features of another tracker, or of a map that it made.
  explicit ScalePyramid(const Features& features)
      : levels_(checked(features.levels)), log_factor_(std::log(features.scale_factor)) {
    scale_[0] = 1.0;
    for (int i = 1; i < levels_; ++i) scale_[i] = scale_[i - 1] * features.scale_factor;
  }

  int levels() const { return levels_; }
  /// Size of a pixel of that level in pixels of the full image.
  double scale(int level) const { return scale_[level]; }
  /// Standard deviation of a keypoint's position in px of the full image.
  double pixel_sigma(int level) const { return scale_[level]; }

  /// Level at which a landmark should be detected from `distance` metres.
  int predict_level(const Landmark& landmark, double distance) const {
    const double level = std::log(landmark.max_distance / distance) / log_factor_;
    return std::clamp(static_cast<int>(std::lround(level)), 0, levels_ - 1);
  }

  /// Sets the range of distances from which the landmark can be found, after it was seen on
  /// `level` from `distance` metres.
  void set_distance_range(Landmark& landmark, int level, double distance) const {
    landmark.max_distance = static_cast<float>(distance * scale(level));
    landmark.min_distance = static_cast<float>(landmark.max_distance / scale(levels_ - 1));
  }

 private:
  static int checked(int levels) {
    if (levels >= 1 && levels <= kMaxLevels) return levels;
    throw Error(Fault::kStage,
                "features of " + std::to_string(levels) + " pyramid levels, not of 1 to " +
                    std::to_string(kMaxLevels),
                "", "take tracker and local mapper of one plugin, and maps that they have made");
  }

  int levels_;
  double log_factor_;
  std::array<double, kMaxLevels> scale_{};
};

}  // namespace stillpoint::orb_slam
