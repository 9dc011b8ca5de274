// Descriptor matching of landmarks to features, for tracking, fusion and relocalisation.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "orb_slam/feature_grid.hpp"
#include "orb_slam/scale_pyramid.hpp"
#include "stillpoint/contracts/features.hpp"
#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/landmark.hpp"

namespace stillpoint::orb_slam {

/// Thresholds on the Hamming distance of matching 256-bit descriptors, as in the ORB-SLAM paper's
/// system: `kLooseDistance` for tracking from a predicted pose, `kStrictDistance` for what changes
/// the map.
inline constexpr int kLooseDistance = 100;
inline constexpr int kStrictDistance = 50;

/// Where and how a landmark should appear.
struct Query {
  std::uint32_t id = 0;  ///< the caller's: a landmark or a feature
  Descriptor descriptor{};
  double u = 0.0, v = 0.0;  ///< px, predicted
  double radius = 0.0;      ///< px, half width of the search window
  int min_level = 0;        ///< pyramid levels to look at
  int max_level = 0;
  float angle = -1.0f;  ///< degrees, of the feature it was seen as; negative: not known
};

struct Match {
  std::uint32_t id = 0;       ///< of the query
  std::uint32_t feature = 0;  ///< that was found
  int distance = 0;           ///< Hamming
};

struct MatchRules {
  int max_distance = kLooseDistance;
  /// A match counts only if the second best of the same level is this much worse; 1 = always.
  double ratio = 1.0;
  /// Drop matches whose orientation difference is not that of most others.
  bool consistent_angles = false;
};

/// Whether a feature may be matched at all.
using FeatureFilter = std::function<bool(std::uint32_t feature)>;

/// Each query takes its closest feature; of queries with the same one, the closest keeps it.
std::vector<Match> match_near(std::span<const Query> queries, const Features& features,
                              const FeatureGrid& grid, const FeatureFilter& usable,
                              const MatchRules& rules);

/// Like match_near, with all features as candidates; `u`, `v`, `radius` and levels are not used.
std::vector<Match> match_anywhere(std::span<const Query> queries, const Features& features,
                                  const FeatureFilter& usable, const MatchRules& rules);

/// A landmark as a camera should see it, with the levels it should be found on and a search window
/// of `radius` px at the predicted level's scale. Nothing when it is outside the image, out of its
/// range of distances or seen from more than 60 degrees off its mean viewing direction.
std::optional<Query> predict(const Landmark& landmark, const Pose& camera_from_world,
                             const Camera& camera, const ScalePyramid& pyramid, double radius);

}  // namespace stillpoint::orb_slam
