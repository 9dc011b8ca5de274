#include "orb_slam/matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace stillpoint::orb_slam {
namespace {

constexpr double kMinViewCosine = 0.5;    // 60 degrees
constexpr double kRangeMargin = 1.2;      // one pyramid level beyond the range of distances
constexpr double kFrontalCosine = 0.998;  // mean viewing direction: accurate prediction
constexpr double kObliqueFactor = 1.6;    // a wider window for all others
constexpr int kAngleBins = 30;
constexpr int kKeptBins = 3;

// The two best candidates of one query.
struct Best {
  int distance = 257, second = 257;
  int level = -1, second_level = -2;
  std::uint32_t feature = 0;

  void offer(int d, std::uint32_t f, int l) {
    if (d < distance) {
      second = distance;
      second_level = level;
      distance = d;
      level = l;
      feature = f;
    } else if (d < second) {
      second = d;
      second_level = l;
    }
  }
  bool accepted(const MatchRules& rules) const {
    if (distance > rules.max_distance) return false;
    return level != second_level || distance <= rules.ratio * second;
  }
};

struct Pair {
  std::uint32_t query = 0;  // index
  std::uint32_t feature = 0;
  int distance = 257;
};

// Keeps, for every feature, the query with the smallest distance.
class Assignment {
 public:
  explicit Assignment(std::size_t features) : best_(features) {}

  void add(std::uint32_t query, std::uint32_t feature, int distance) {
    if (distance < best_[feature].distance) best_[feature] = {query, feature, distance};
  }
  std::vector<Pair> pairs() && {
    std::erase_if(best_, [](const Pair& p) { return p.distance > 256; });
    return std::move(best_);
  }

 private:
  std::vector<Pair> best_;
};

int angle_bin(float from, float to) {
  float turn = from - to;
  if (turn < 0) turn += 360.0f;
  return static_cast<int>(turn * kAngleBins / 360.0f) % kAngleBins;
}

// Rotation consistency check: the camera's roll rotates all features alike, so that true matches
// gather in a few bins of the orientation difference.
void keep_consistent_angles(std::span<const Query> queries, const Features& features,
                            std::vector<Pair>& pairs) {
  const auto bin = [&](const Pair& p) {
    const float angle = queries[p.query].angle;
    return angle < 0 ? -1 : angle_bin(angle, features.keypoints[p.feature].angle);
  };
  std::array<int, kAngleBins> count{};
  for (const Pair& p : pairs)
    if (const int b = bin(p); b >= 0) ++count[b];
  std::array<int, kAngleBins> order;
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return count[a] > count[b]; });
  std::array<bool, kAngleBins> kept{};
  for (int i = 0; i < kKeptBins; ++i) kept[order[i]] = count[order[i]] * 10 >= count[order[0]];
  std::erase_if(pairs, [&](const Pair& p) { return bin(p) >= 0 && !kept[bin(p)]; });
}

std::vector<Match> finish(Assignment assignment, std::span<const Query> queries,
                          const Features& features, const MatchRules& rules) {
  std::vector<Pair> pairs = std::move(assignment).pairs();
  if (rules.consistent_angles) keep_consistent_angles(queries, features, pairs);
  std::vector<Match> matches;
  for (const Pair& p : pairs) matches.push_back({queries[p.query].id, p.feature, p.distance});
  return matches;
}

// Features that a query may match.
struct Candidates {
  std::vector<std::uint32_t> features;
  std::vector<Descriptor> descriptors;
  std::vector<std::uint16_t> distances;

  void clear() {
    features.clear();
    descriptors.clear();
  }
  void add(std::uint32_t feature, const Descriptor& descriptor) {
    features.push_back(feature);
    descriptors.push_back(descriptor);
  }
  void compare_with(const Descriptor& query) {
    distances.resize(descriptors.size());
    distances_to_all(query, descriptors.data(), descriptors.size(), distances.data());
  }

 private:
  // popcnt is no part of the x86-64 baseline; all matching ends here, so it pays to use it.
  __attribute__((target_clones("popcnt", "default"))) static void distances_to_all(
      const Descriptor& descriptor, const Descriptor* others, std::size_t count,
      std::uint16_t* out) {
    for (std::size_t i = 0; i < count; ++i) {
      const Descriptor& o = others[i];
      out[i] = static_cast<std::uint16_t>(
          __builtin_popcountll(descriptor[0] ^ o[0]) + __builtin_popcountll(descriptor[1] ^ o[1]) +
          __builtin_popcountll(descriptor[2] ^ o[2]) + __builtin_popcountll(descriptor[3] ^ o[3]));
    }
  }
};

}  // namespace

std::vector<Match> match_near(std::span<const Query> queries, const Features& features,
                              const FeatureGrid& grid, const FeatureFilter& usable,
                              const MatchRules& rules) {
  Assignment assignment(features.size());
  std::vector<bool> open(features.size());
  for (std::uint32_t i = 0; i < features.size(); ++i) open[i] = usable(i);
  Candidates candidates;
  for (std::uint32_t q = 0; q < queries.size(); ++q) {
    const Query& query = queries[q];
    candidates.clear();
    grid.for_each_near(query.u, query.v, query.radius, [&](std::uint32_t i) {
      const int level = features.keypoints[i].octave;
      if (level >= query.min_level && level <= query.max_level && open[i])
        candidates.add(i, features.descriptors[i]);
    });
    candidates.compare_with(query.descriptor);
    Best best;
    for (std::size_t i = 0; i < candidates.features.size(); ++i) {
      const std::uint32_t feature = candidates.features[i];
      best.offer(candidates.distances[i], feature, features.keypoints[feature].octave);
    }
    if (best.accepted(rules)) assignment.add(q, best.feature, best.distance);
  }
  return finish(std::move(assignment), queries, features, rules);
}

std::vector<Match> match_anywhere(std::span<const Query> queries, const Features& features,
                                  const FeatureFilter& usable, const MatchRules& rules) {
  Candidates candidates;
  for (std::uint32_t i = 0; i < features.size(); ++i)
    if (usable(i)) candidates.add(i, features.descriptors[i]);
  Assignment assignment(features.size());
  for (std::uint32_t q = 0; q < queries.size(); ++q) {
    candidates.compare_with(queries[q].descriptor);
    Best best;
    for (std::size_t i = 0; i < candidates.features.size(); ++i)
      best.offer(candidates.distances[i], candidates.features[i], 0);
    best.second_level = best.level;  // ratio test against all features, of whatever level
    if (best.accepted(rules)) assignment.add(q, best.feature, best.distance);
  }
  return finish(std::move(assignment), queries, features, rules);
}

std::optional<Query> predict(const Landmark& landmark, const Pose& camera_from_world,
                             const Camera& camera, const ScalePyramid& pyramid, double radius) {
  const Eigen::Vector3d p = camera_from_world * landmark.position_in_world;
  if (p.z() <= 0.0) return std::nullopt;
  const Eigen::Vector2d pixel = camera.project(p);
  if (!camera.contains(pixel.x(), pixel.y())) return std::nullopt;
  const double distance = p.norm();
  if (distance < landmark.min_distance / kRangeMargin ||
      distance > landmark.max_distance * kRangeMargin)
    return std::nullopt;
  const double cosine = (camera_from_world.linear() * landmark.mean_view).dot(p) / distance;
  if (cosine < kMinViewCosine) return std::nullopt;

  const int level = pyramid.predict_level(landmark, distance);
  const double window = cosine > kFrontalCosine ? radius : kObliqueFactor * radius;
  return Query{.id = landmark.id,
               .descriptor = landmark.descriptor,
               .u = pixel.x(),
               .v = pixel.y(),
               .radius = window * pyramid.scale(level),
               .min_level = level - 1,
               .max_level = level + 1};
}

}  // namespace stillpoint::orb_slam
