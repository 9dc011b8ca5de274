#include "decision_objects/motion_field.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stillpoint/support/depth_step.hpp"
#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::decision_objects {
namespace {

constexpr float kMaxEvidence = 4.0F;         // log-odds, clamped so that new evidence can revert it
constexpr float kNeutralWeight = 0.5F;       // weight of no evidence, against those of points
constexpr double kReachWithoutDepth = 12.0;  // px of 640 x 480, where there is no depth
constexpr double kMaxReach = 80.0;  // px of 640 x 480; limits the reach on very near surfaces

/// Depth in the middle of each cell.
void sample_depth(const cv::Mat& depth, cv::Mat& cells) {
  constexpr int kCell = MotionField::kCell;
  cells.create(depth.rows / kCell, depth.cols / kCell, CV_32F);
  for (int y = 0; y < cells.rows; ++y) {
    const auto* in = depth.ptr<float>(y * kCell + kCell / 2) + kCell / 2;
    auto* out = cells.ptr<float>(y);
    for (int x = 0; x < cells.cols; ++x) out[x] = in[x * kCell];
  }
}

}  // namespace

void MotionFieldOptions::visit(OptionVisitor& v) {
  v("moving_evidence", moving_evidence,
    {.min = 0,
     .max = 10,
     .unit = "log-odds",
     .help = "evidence of moving added on the surface around a moving point"});
  v("static_evidence", static_evidence,
    {.min = 0,
     .max = 10,
     .unit = "log-odds",
     .help = "evidence of moving subtracted on the surface around a static point"});
  v("kept_evidence", kept_evidence,
    {.min = 0, .max = 1, .help = "share of evidence kept to the next frame"});
  v("reach", reach,
    {.min = 0.01, .max = 2, .unit = "m", .help = "how far the evidence of a point reaches"});
  v("depth_gate", depth_gate,
    {.min = 0.001,
     .max = 1,
     .help = "relative difference in depth from which pixels lie on another surface"});
}

void MotionField::update(const Frame& frame, const MovingPoints& moving) {
  sample_depth(frame.depth, depth_);
  evidence_ = cv::Mat::zeros(depth_.size(), CV_32F);
  weight_ = cv::Mat::zeros(depth_.size(), CV_32F);
  for (const PointMotion& point : moving.points) {
    const float measured = !moving.reliable
                               ? 0.0F
                               : static_cast<float>(point.moving ? options_.moving_evidence
                                                                 : -options_.static_evidence);
    const float evidence =
        static_cast<float>(options_.kept_evidence) * previous_log_odds(point.previous) + measured;
    spread(frame, point.current, std::clamp(evidence, -kMaxEvidence, kMaxEvidence));
  }
  log_odds_.create(depth_.size(), CV_32F);
  for (int y = 0; y < log_odds_.rows; ++y) {
    const auto* evidence = evidence_.ptr<float>(y);
    const auto* weight = weight_.ptr<float>(y);
    auto* out = log_odds_.ptr<float>(y);
    for (int x = 0; x < log_odds_.cols; ++x) out[x] = evidence[x] / (weight[x] + kNeutralWeight);
  }
}

float MotionField::previous_log_odds(const cv::Point2f& pixel) const {
  const cv::Point cell(cvFloor(pixel.x) / kCell, cvFloor(pixel.y) / kCell);
  if (!cv::Rect({0, 0}, log_odds_.size()).contains(cell)) return 0;
  return log_odds_.at<float>(cell);
}

void MotionField::spread(const Frame& frame, const cv::Point2f& pixel, float evidence) {
  const cv::Point centre(cvFloor(pixel.x) / kCell, cvFloor(pixel.y) / kCell);
  if (!cv::Rect({0, 0}, depth_.size()).contains(centre)) return;
  const float z = depth_.at<float>(centre);
  const float focal = static_cast<float>(frame.camera->fx);
  const double scale = pixel_scale(frame.depth.size());
  const float reach = (z > 0 ? static_cast<float>(options_.reach) * focal / z
                             : static_cast<float>(kReachWithoutDepth * scale)) /
                      kCell;
  const int cells =
      static_cast<int>(std::min(reach, static_cast<float>(kMaxReach * scale) / kCell));
  // Without depth, the gate is open for every surface.
  const float gate = z > 0 ? DepthStep{static_cast<float>(options_.depth_gate)}.limit(z)
                           : std::numeric_limits<float>::infinity();
  const float falloff = 1 / (reach * reach);
  for (int y = std::max(0, centre.y - cells); y <= std::min(depth_.rows - 1, centre.y + cells);
       ++y) {
    const auto* depth = depth_.ptr<float>(y);
    auto* sum = evidence_.ptr<float>(y);
    auto* weights = weight_.ptr<float>(y);
    const auto dy = static_cast<float>(y - centre.y);
    const int first = std::max(0, centre.x - cells);
    const int last = std::min(depth_.cols - 1, centre.x + cells);
    for (int x = first; x <= last; ++x) {  // without branches: vectorised
      const auto dx = static_cast<float>(x - centre.x);
      const float near = std::max(0.0F, 1 - (dx * dx + dy * dy) * falloff);
      const bool other = (depth[x] > 0) & (std::abs(depth[x] - z) > gate);
      const float weight = other ? 0.0F : near;
      sum[x] += weight * evidence;
      weights[x] += weight;
    }
  }
}

}  // namespace stillpoint::decision_objects
