// Sparse optical flow (pyramidal Lucas–Kanade): lines 1 and 2 of Algorithm 1.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <span>
#include <vector>

#include "moving_checks/corners.hpp"
#include "stillpoint/contracts/frame.hpp"

namespace stillpoint::moving_checks {

struct FollowOptions {
  CornerOptions corners;
  int window = 11;                    ///< px, side of the patch that is followed
  int pyramid_levels = 4;             ///< the image itself included
  int iterations = 15;                ///< per level
  double accuracy = 0.02;             ///< px, a smaller step ends the iterations
  double edge = 5.0;                  ///< px, nearer to the image edge a match is discarded
  double max_patch_difference = 200;  ///< grey levels, summed over 3 × 3 px

  void visit(OptionVisitor& v);
};

/// A point in the previous and in the current frame.
struct Match {
  cv::Point2f previous;  ///< px
  cv::Point2f current;   ///< px
  int kept_index = -1;   ///< into the points given to follow(), -1: a new corner
};

/// Keeps the image pyramid of the last frame: the next call's previous frame is that one.
class PointFollower {
 public:
  explicit PointFollower(const FollowOptions& options) : options_(options) {}

  /// Empty unless both images are gray, of one size and large enough for optical flow. `kept` are
  /// points of the previous frame to track further (`corners: grid` only).
  std::vector<Match> follow(const Frame& previous, const Frame& current,
                            std::span<const cv::Point2f> kept = {});

  /// Follows points of the last call's previous frame again, from a guess of where they are.
  /// Nothing for those that are discarded.
  std::vector<std::optional<cv::Point2f>> follow_from(
      const std::vector<cv::Point2f>& points, const std::vector<cv::Point2f>& guesses) const;

 private:
  struct Pyramid {
    cv::Mat image;                ///< shares its pixels with the frame, which is never changed
    std::vector<cv::Mat> levels;  ///< of cv::buildOpticalFlowPyramid, with derivatives
  };

  Pyramid pyramid_of(const cv::Mat& gray) const;
  void track(const std::vector<cv::Point2f>& points, std::vector<cv::Point2f>& followed,
             std::vector<std::uint8_t>& found, int levels, int flags) const;
  bool accepted(const cv::Point2f& from, const cv::Point2f& to) const;
  bool usable(const cv::Mat& previous, const cv::Mat& current) const;
  std::vector<Match> matches(const Corners& corners) const;

  FollowOptions options_;
  Pyramid previous_, current_;  // of the last call
};

}  // namespace stillpoint::moving_checks
