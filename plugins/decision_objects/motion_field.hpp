// Dense motion probability from sparse points: evidence spreads over the surface around each
// point and travels with the points from frame to frame. Needs no labels.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint::decision_objects {

struct MotionFieldOptions {
  double moving_evidence = 1.5;  ///< log-odds that a moving point adds
  double static_evidence = 0.7;  ///< log-odds that a static point subtracts
  double kept_evidence = 0.85;   ///< share of a point's evidence kept from frame to frame
  double reach = 0.2;            ///< m
  double depth_gate = 0.08;

  void visit(OptionVisitor& visitor);
};

/// Log-odds of moving on a grid of kCell px; 0 where nothing is known. Feed it every frame in
/// order.
class MotionField {
 public:
  static constexpr int kCell = 4;  // px

  explicit MotionField(const MotionFieldOptions& options) : options_(options) {}

  /// Points that are not reliable add no evidence; they only carry theirs on.
  void update(const Frame& frame, const MovingPoints& moving);

  /// CV_32FC1, one value per cell; empty before the first update.
  const cv::Mat& log_odds() const { return log_odds_; }

 private:
  float previous_log_odds(const cv::Point2f& pixel) const;
  void spread(const Frame& frame, const cv::Point2f& pixel, float evidence);

  MotionFieldOptions options_;
  cv::Mat log_odds_;
  cv::Mat depth_;     // CV_32FC1, m, per cell; 0 = none
  cv::Mat evidence_;  // CV_32FC1, per cell: weighted sum of the evidence of points near it
  cv::Mat weight_;    // CV_32FC1, per cell: sum of their weights
};

}  // namespace stillpoint::decision_objects
