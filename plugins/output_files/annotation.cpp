#include "output_files/annotation.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <opencv2/imgproc.hpp>

namespace stillpoint::output_files {
namespace {

using Use = TrackedFeature::Use;

// BGR. Those of features and evidence are safe for colour blindness (Okabe and Ito, 2008).
const cv::Scalar kInlier(115, 158, 0);
const cv::Scalar kOutlier(66, 228, 240);
const cv::Scalar kMoving(0, 94, 213);
const cv::Scalar kUnmatched(170, 170, 170);
const cv::Scalar kMovingMask(40, 60, 255);
const cv::Scalar kStaticMask(235, 160, 60);
const cv::Scalar kFreeSpaceViolation(167, 121, 204);
const cv::Scalar kConsistent(233, 180, 86);
const cv::Scalar kText(255, 255, 255);

constexpr double kCertainLogOdds = 4;  // log-odds of the map check that are shown as static

void tint(cv::Mat& picture, const cv::Mat& mask, const cv::Scalar& colour) {
  cv::Mat tinted;
  cv::addWeighted(picture, 0.6, cv::Mat(picture.size(), picture.type(), colour), 0.4, 0.0, tinted);
  tinted.copyTo(picture, mask);
  std::vector<std::vector<cv::Point>> contours;
  cv::findContours(mask, contours, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_SIMPLE);
  cv::drawContours(picture, contours, -1, colour, 1, cv::LINE_AA);
}

// Labelled objects in blue; pixels excluded from tracking in red, labelled or not.
void draw_mask(cv::Mat& picture, const FrameReport& report) {
  const cv::Mat& labels = report.segmentation->labels;
  const cv::Mat& weights = report.weights->track;
  cv::Mat labelled = cv::Mat::zeros(picture.size(), CV_8UC1);
  cv::Mat unused = cv::Mat::zeros(picture.size(), CV_8UC1);
  if (labels.size() == picture.size()) labelled = labels > 0;
  if (weights.size() == picture.size()) unused = weights < 128;
  tint(picture, labelled & ~unused, kStaticMask);
  tint(picture, unused, kMovingMask);
}

// Free-space violations, and surfaces that are consistent with earlier frames.
void draw_evidence(cv::Mat& picture, const cv::Mat& log_odds) {
  if (log_odds.empty()) return;
  cv::Mat pixels;
  cv::resize(log_odds, pixels, picture.size(), 0, 0, cv::INTER_NEAREST);
  tint(picture, pixels > 0, kFreeSpaceViolation);
  tint(picture, pixels <= -kCertainLogOdds, kConsistent);
}

void draw_moving(cv::Mat& picture, const MovingPoints& moving) {
  for (const PointMotion& point : moving.points) {
    if (!point.moving) continue;
    cv::line(picture, point.previous, point.current, kMoving, 1, cv::LINE_AA);
    cv::circle(picture, point.current, 3, kMoving, cv::FILLED, cv::LINE_AA);
  }
}

void draw_features(cv::Mat& picture, const std::vector<TrackedFeature>& features) {
  for (const TrackedFeature& feature : features) {
    switch (feature.use) {
      case Use::kUnmatched:
        cv::circle(picture, feature.pixel, 1, kUnmatched, cv::FILLED, cv::LINE_AA);
        break;
      case Use::kInlier:
        cv::circle(picture, feature.pixel, 3, kInlier, 1, cv::LINE_AA);
        cv::circle(picture, feature.pixel, 1, kInlier, cv::FILLED, cv::LINE_AA);
        break;
      case Use::kOutlier:
        cv::drawMarker(picture, feature.pixel, kOutlier, cv::MARKER_TILTED_CROSS, 6, 1,
                       cv::LINE_AA);
        break;
      case Use::kMoving:
        cv::drawMarker(picture, feature.pixel, kMoving, cv::MARKER_TILTED_CROSS, 6, 1, cv::LINE_AA);
        break;
    }
  }
}

void draw_text(cv::Mat& picture, const FrameReport& report) {
  const int height = std::max(16, picture.rows / 22);
  cv::Mat bar = picture.rowRange(std::max(0, picture.rows - height), picture.rows);
  const bool lost = report.result.state == TrackState::kLost;
  bar.convertTo(bar, -1, 0.35);
  if (lost) bar += kMoving * 0.5;
  std::array<char, 160> text{};
  std::snprintf(text.data(), text.size(), "%5u  %.3f s  %s  %d of %d matches fit%s",
                report.frame->index, report.frame->time, name_of(report.result.state),
                report.result.inliers, report.result.matches,
                report.result.keyframe ? "  key frame" : "");
  cv::putText(picture, text.data(), {6, picture.rows - height / 3}, cv::FONT_HERSHEY_SIMPLEX,
              height / 44.0, kText, 1, cv::LINE_AA);
}

}  // namespace

cv::Mat annotated(const FrameReport& report, const AnnotationParts& parts) {
  cv::Mat picture = report.frame->bgr.clone();
  if (parts.mask) draw_mask(picture, report);
  if (parts.evidence) draw_evidence(picture, report.evidence.log_odds);
  if (parts.features) draw_features(picture, report.result.tracked);
  if (parts.moving) draw_moving(picture, report.moving);
  if (parts.text) draw_text(picture, report);
  return picture;
}

}  // namespace stillpoint::output_files
