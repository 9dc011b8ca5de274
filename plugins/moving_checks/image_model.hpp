// Models of the image motion of static points: fundamental matrix or homography.
// Line 3 to 6 of Algorithm 1.
#pragma once

#include <opencv2/core/matx.hpp>
#include <opencv2/core/types.hpp>
#include <optional>
#include <vector>

#include "stillpoint/options.hpp"

namespace stillpoint::moving_checks {

using Points = std::vector<cv::Point2f>;

/// Robust estimator of the model.
enum class Consensus { kRansac, kUsac, kMagsac };

struct ConsensusOptions {
  double ransac_threshold = 1.0;  ///< px
  double confidence = 0.99;       ///< that the best sample has been drawn
  int max_iterations = 1000;

  void visit(OptionVisitor& v);
};

/// A model with its inliers.
struct ImageModel {
  cv::Matx33d matrix;                 ///< current ~ matrix · previous, or the fundamental matrix
  std::vector<std::uint8_t> inliers;  ///< per match, 0 or 1
  int inlier_count = 0;
};

/// Fundamental matrix with currentᵀ F previous = 0; nothing when there is none. With `seed` for
/// the estimators that take one: cv::findFundamentalMat's own RANSAC draws the same samples always.
std::optional<ImageModel> find_fundamental(const Points& previous, const Points& current,
                                           Consensus consensus, const ConsensusOptions& options,
                                           int seed);

std::optional<ImageModel> find_homography(const Points& previous, const Points& current,
                                          const ConsensusOptions& options);

/// Px from the point in the current image to its epipolar line (eq. 1–3).
double epipolar_distance(const cv::Matx33d& fundamental, const cv::Point2f& previous,
                         const cv::Point2f& current);

/// Px from the point in the current image to where the homography puts it.
double transfer_distance(const cv::Matx33d& homography, const cv::Point2f& previous,
                         const cv::Point2f& current);

}  // namespace stillpoint::moving_checks
