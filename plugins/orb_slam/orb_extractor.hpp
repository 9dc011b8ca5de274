// ORB features (Rublee et al., ICCV 2011) with corners spread over the image as SLAM needs them
// (Mur-Artal et al., T-RO 2015, section V): FAST on a scale pyramid, intensity-centroid
// orientation, rotated BRIEF.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "orb_slam/fast_corners.hpp"
#include "stillpoint/contracts/features.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint::orb_slam {

struct OrbOptions {
  int features = 1000;
  int levels = 8;
  double scale_factor = 1.2;
  int fast_threshold = 20;
  int fast_min_threshold = 7;
  double oversampling = 1.5;
  bool subpixel = true;

  void visit(OptionVisitor& v);
};

/// Keeps its buffers between images; one object per thread.
class OrbExtractor {
 public:
  explicit OrbExtractor(const OrbOptions& options);

  /// Features of a CV_8UC1 image, level by level, strongest first; `depth` stays empty. `share`
  /// times as many as the options say; fewer where the image has too few corners, none where it is
  /// smaller than a patch. Where `fallback` (CV_8U, the image's size; empty: nowhere) is not zero,
  /// features are taken only when the rest of the image has fewer than the options say. Keypoints
  /// are in px of `gray` with pixel centres at whole numbers. Throws Error for another type of
  /// image.
  Features extract(const cv::Mat& gray, const cv::Mat& fallback = {}, double share = 1.0);

  /// Features wanted of each level: in proportion to the level's width.
  const std::vector<int>& features_per_level() const { return features_per_level_; }

 private:
  void build_pyramid(const cv::Mat& gray);
  void detect(const cv::Mat& image, const cv::Mat& fallback, int count, double share);
  void keep_best(std::vector<Corner>& corners, cv::Size image, int count) const;
  void describe(const cv::Mat& image, int level, cv::Size full_size, Features& features);

  OrbOptions options_;
  std::vector<int> features_per_level_;
  std::vector<cv::Mat> pyramid_;
  cv::Mat blurred_;
  FastDetector fast_;
  std::vector<Corner> corners_;           // of the level at hand
  std::vector<Corner> fallback_corners_;  // those inside the mask of fallback areas
};

}  // namespace stillpoint::orb_slam
