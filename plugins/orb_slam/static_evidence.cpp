#include "orb_slam/static_evidence.hpp"

#include <vector>

namespace stillpoint::orb_slam {
namespace {

constexpr float kInlierLogOdds = 0.2F;  // log-odds of being static per inlier match of full weight
constexpr float kViolationLogOdds = 0.5F;  // log-odds against it per violation
constexpr double kFreeSpaceMargin = 0.2;   // relative: measured depth beyond the landmark
constexpr int kEdgeRadius = 2;  // px; free space beside a depth discontinuity proves nothing

/// Whether all depth around the landmark's projection is farther than the landmark: it would lie in
/// free space.
bool violates_free_space(const Frame& frame, const Eigen::Vector3d& in_camera) {
  const Eigen::Vector2d at = frame.camera->project(in_camera);
  const cv::Point pixel(cvRound(at.x()), cvRound(at.y()));
  const cv::Mat& depth = frame.depth;
  const cv::Rect inside(kEdgeRadius, kEdgeRadius, depth.cols - 2 * kEdgeRadius,
                        depth.rows - 2 * kEdgeRadius);
  if (!inside.contains(pixel)) return false;
  for (int y = pixel.y - kEdgeRadius; y <= pixel.y + kEdgeRadius; ++y) {
    const auto* row = depth.ptr<float>(y);
    for (int x = pixel.x - kEdgeRadius; x <= pixel.x + kEdgeRadius; ++x)
      if (row[x] <= (1 + kFreeSpaceMargin) * in_camera.z()) return false;
  }
  return true;
}

}  // namespace

void add_static_evidence(const ObservedFrame& frame, const SparseMap& map,
                         std::span<const LandmarkId> visible, EvidenceByLandmark& evidence) {
  std::vector<bool> matched(map.landmark_id_end());
  for (std::size_t i = 0; i < frame.landmarks.size(); ++i) {
    const LandmarkId id = frame.landmarks[i];
    if (id == kNoId || frame.outlier[i]) continue;
    matched[id] = true;
    LandmarkEvidence& e = evidence[id];
    ++e.found;
    e.static_log_odds += kInlierLogOdds * static_cast<float>(frame.track_weights[i]) / 255;
  }
  const Pose camera_from_world = frame.world_from_camera.inverse();
  for (const LandmarkId id : visible) {
    LandmarkEvidence& e = evidence[id];
    ++e.visible;
    if (matched[id]) continue;
    if (violates_free_space(*frame.frame, camera_from_world * map.landmark(id)->position_in_world))
      e.static_log_odds -= kViolationLogOdds;
  }
}

}  // namespace stillpoint::orb_slam
