#include "moving_checks/lk_checker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stillpoint::moving_checks {

namespace {

struct Pairs {
  Points previous, current;
};

Pairs pairs_of(const std::vector<Match>& matches) {
  Pairs pairs;
  for (const Match& match : matches) {
    pairs.previous.push_back(match.previous);
    pairs.current.push_back(match.current);
  }
  return pairs;
}

Pairs inliers_of(const Pairs& pairs, const ImageModel& model) {
  Pairs inliers;
  for (std::size_t i = 0; i < model.inliers.size(); ++i) {
    if (!model.inliers[i]) continue;
    inliers.previous.push_back(pairs.previous[i]);
    inliers.current.push_back(pairs.current[i]);
  }
  return inliers;
}

MovingPoints unclassified(const std::vector<Match>& matches) {
  MovingPoints result;
  for (const Match& match : matches)
    result.points.push_back({.previous = match.previous, .current = match.current});
  return result;
}

template <class Distance>
MovingPoints classified(const std::vector<Match>& matches, double epsilon, Distance distance) {
  MovingPoints result = unclassified(matches);
  for (PointMotion& point : result.points) {
    const double residual = distance(point.previous, point.current);
    point.residual =
        static_cast<float>(std::min(residual, 1.0 * std::numeric_limits<float>::max()));
    point.moving = residual > epsilon;
  }
  result.reliable = true;
  return result;
}

MovingPoints classified_by_homography(const std::vector<Match>& matches, double epsilon,
                                      const ImageModel& model) {
  return classified(matches, epsilon, [&](const cv::Point2f& previous, const cv::Point2f& current) {
    return transfer_distance(model.matrix, previous, current);
  });
}

bool enough_inliers(const ImageModel& model, const std::vector<Match>& matches, double share) {
  return model.inlier_count >= share * static_cast<double>(matches.size());
}

// Transfer error under the homography that a share of the matches reaches, in px. Noise alone gives
// some tenths; only larger parallax determines a fundamental matrix.
double parallax(const Pairs& inliers, const ImageModel& homography, double share) {
  std::vector<double> distances;
  for (std::size_t i = 0; i < inliers.previous.size(); ++i)
    distances.push_back(
        transfer_distance(homography.matrix, inliers.previous[i], inliers.current[i]));
  const auto below = static_cast<std::size_t>(static_cast<double>(distances.size()) * (1 - share));
  const auto nth = distances.begin() + static_cast<std::ptrdiff_t>(below);
  std::nth_element(distances.begin(), nth, distances.end());
  return *nth;
}

}  // namespace

void LkOptions::visit(OptionVisitor& v) {
  consensus.visit(v);
  follow.visit(v);
  v("min_matches", min_matches,
    {.min = 8,
     .max = 100000,
     .help = "matches needed; with fewer the check is not reliable; not in the paper"});
  v("min_inlier_share", min_inlier_share,
    {.min = 0,
     .max = 1,
     .help = "share of inliers needed; with fewer the check is not reliable; not in the paper"});
}

void EpipolarChecker::Options::visit(OptionVisitor& v) {
  v("epsilon", epsilon,
    {.min = 0,
     .unit = "px",
     .help = "a point farther from its epipolar line moves (eq. 3; Algorithm 1, line 7)"});
  lk.visit(v);
  v("min_parallax", min_parallax,
    {.min = 0,
     .unit = "px",
     .help = "a point has parallax when one homography misplaces it by this much; without parallax "
             "the fundamental matrix is degenerate; not in the paper"});
  v("parallax_share", parallax_share,
    {.min = 0.01,
     .max = 1,
     .help = "share of the inliers that must have parallax; with fewer, when_degenerate says what "
             "happens"});
  v.choice("when_degenerate", when_degenerate,
           {{"unreliable", Degenerate::kUnreliable},
            {"homography", Degenerate::kHomography},
            {"ignore", Degenerate::kIgnore}},
           {.help = "without parallax, the check is not reliable, uses a homography, or goes on as "
                    "in the paper"});
}

EpipolarChecker::EpipolarChecker(const Options& options, Consensus consensus,
                                 const StageContext& context)
    : options_(options),
      consensus_(consensus),
      seed_(static_cast<int>(context.seed % 0x7fffffff)),
      follower_(options.lk.follow) {}

MovingPoints EpipolarChecker::check(const Frame& previous, const Frame& current,
                                    const TrackingHistory&) {
  const std::vector<Match> matches = follower_.follow(previous, current);
  if (matches.size() < static_cast<std::size_t>(options_.lk.min_matches))
    return unclassified(matches);
  const Pairs pairs = pairs_of(matches);
  const auto model =
      find_fundamental(pairs.previous, pairs.current, consensus_, options_.lk.consensus, seed_);
  if (!model || !enough_inliers(*model, matches, options_.lk.min_inlier_share))
    return unclassified(matches);
  if (options_.when_degenerate != Degenerate::kIgnore) {
    const Pairs inliers = inliers_of(pairs, *model);
    const auto plane = find_homography(inliers.previous, inliers.current, options_.lk.consensus);
    if (plane && parallax(inliers, *plane, options_.parallax_share) < options_.min_parallax) {
      if (options_.when_degenerate == Degenerate::kUnreliable) return unclassified(matches);
      return classified_by_homography(matches, options_.epsilon, *plane);
    }
  }
  return classified(matches, options_.epsilon, [&](const cv::Point2f& from, const cv::Point2f& to) {
    return epipolar_distance(model->matrix, from, to);
  });
}

void LkHomography::Options::visit(OptionVisitor& v) {
  v("epsilon", epsilon,
    {.min = 0, .unit = "px", .help = "a point with a larger transfer error moves"});
  lk.visit(v);
}

MovingPoints LkHomography::check(const Frame& previous, const Frame& current,
                                 const TrackingHistory&) {
  const std::vector<Match> matches = follower_.follow(previous, current);
  if (matches.size() < static_cast<std::size_t>(options_.lk.min_matches))
    return unclassified(matches);
  const Pairs pairs = pairs_of(matches);
  const auto model = find_homography(pairs.previous, pairs.current, options_.lk.consensus);
  if (!model || !enough_inliers(*model, matches, options_.lk.min_inlier_share))
    return unclassified(matches);
  return classified_by_homography(matches, options_.epsilon, *model);
}

}  // namespace stillpoint::moving_checks
