#include "moving_checks/image_model.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/calib3d.hpp>

namespace stillpoint::moving_checks {
namespace {

// OpenCV gives an empty matrix, several stacked ones, or throws when the matches determine none.
template <class Find>
std::optional<ImageModel> model_of(Find find) {
  ImageModel model;
  cv::Mat matrix;
  try {
    matrix = find(model.inliers);
  } catch (const cv::Exception&) {
    return std::nullopt;
  }
  if (matrix.rows < 3 || matrix.cols != 3 || matrix.type() != CV_64F) return std::nullopt;
  model.matrix = cv::Matx33d(matrix.ptr<double>());
  if (!cv::checkRange(matrix)) return std::nullopt;
  model.inlier_count = static_cast<int>(std::count_if(
      model.inliers.begin(), model.inliers.end(), [](std::uint8_t inlier) { return inlier != 0; }));
  return model;
}

cv::UsacParams usac_params(Consensus consensus, const ConsensusOptions& options, int seed) {
  cv::UsacParams params;
  params.threshold = options.ransac_threshold;
  params.confidence = options.confidence;
  params.maxIterations = options.max_iterations;
  params.randomGeneratorState = seed;
  params.isParallel = false;
  if (consensus == Consensus::kMagsac) {
    params.score = cv::SCORE_METHOD_MAGSAC;
    params.loMethod = cv::LOCAL_OPTIM_SIGMA;
    params.loIterations = 10;
  }
  return params;
}

}  // namespace

void ConsensusOptions::visit(OptionVisitor& v) {
  v("ransac_threshold", ransac_threshold,
    {.min = 0.01,
     .max = 100,
     .unit = "px",
     .help = "inlier threshold of RANSAC (Algorithm 1, line 3)"});
  v("confidence", confidence,
    {.min = 0.5,
     .max = 0.999999,
     .help = "probability that RANSAC has drawn a sample of inliers (line 3)"});
  v("max_iterations", max_iterations,
    {.min = 1, .max = 1000000, .help = "samples of RANSAC at most (line 3)"});
}

std::optional<ImageModel> find_fundamental(const Points& previous, const Points& current,
                                           Consensus consensus, const ConsensusOptions& options,
                                           int seed) {
  return model_of([&](std::vector<std::uint8_t>& inliers) {
    if (consensus == Consensus::kRansac)
      return cv::findFundamentalMat(previous, current, cv::FM_RANSAC, options.ransac_threshold,
                                    options.confidence, options.max_iterations, inliers);
    return cv::findFundamentalMat(previous, current, inliers,
                                  usac_params(consensus, options, seed));
  });
}

std::optional<ImageModel> find_homography(const Points& previous, const Points& current,
                                          const ConsensusOptions& options) {
  return model_of([&](std::vector<std::uint8_t>& inliers) {
    return cv::findHomography(previous, current, cv::RANSAC, options.ransac_threshold, inliers,
                              options.max_iterations, options.confidence);
  });
}

double epipolar_distance(const cv::Matx33d& fundamental, const cv::Point2f& previous,
                         const cv::Point2f& current) {
  const cv::Vec3d line = fundamental * cv::Vec3d(previous.x, previous.y, 1);  // eq. 2
  const double length = std::hypot(line[0], line[1]);
  if (length == 0) return 0;  // the epipole itself has no line
  return std::abs(line.dot(cv::Vec3d(current.x, current.y, 1))) / length;  // eq. 3
}

double transfer_distance(const cv::Matx33d& homography, const cv::Point2f& previous,
                         const cv::Point2f& current) {
  const cv::Vec3d moved = homography * cv::Vec3d(previous.x, previous.y, 1);
  if (moved[2] == 0) return std::numeric_limits<double>::infinity();
  return std::hypot(moved[0] / moved[2] - current.x, moved[1] / moved[2] - current.y);
}

}  // namespace stillpoint::moving_checks
