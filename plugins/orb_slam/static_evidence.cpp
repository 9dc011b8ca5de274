#include "orb_slam/static_evidence.hpp"

#include <algorithm>
#include <vector>

#include "stillpoint/support/pixel_scale.hpp"

namespace stillpoint::orb_slam {
namespace {

constexpr float kInlierLogOdds = 0.2F;  // log-odds of being static per inlier match of full weight
constexpr float kViolationLogOdds = 0.5F;  // log-odds against it per violation
constexpr double kFreeSpaceMargin = 0.2;   // relative: measured depth beyond the landmark
constexpr double kOcclusionMargin = 0.1;   // relative: measured depth before the landmark
constexpr double kRate = 30;               // Hz, that the log-odds of a frame are meant for
constexpr double kLeastShare = 0.5, kMostShare = 3;  // of them, at other rates and after gaps
// px of 640 x 480; free space beside a depth discontinuity proves nothing.
constexpr double kEdgeRadius = 2;

enum class Visibility { kOpen, kOccluded, kFreeSpace };

/// kFreeSpace: all depth around the landmark's projection is farther than the landmark.
Visibility visibility(const Frame& frame, const Eigen::Vector3d& in_camera) {
  if (in_camera.z() <= 0) return Visibility::kOccluded;  // behind the camera, at its latest pose
  const Eigen::Vector2d at = frame.camera->project(in_camera);
  const cv::Point pixel(cvRound(at.x()), cvRound(at.y()));
  const cv::Mat& depth = frame.depth;
  const int radius = cvRound(kEdgeRadius * pixel_scale(depth.size()));
  const cv::Rect inside(radius, radius, depth.cols - 2 * radius, depth.rows - 2 * radius);
  if (!inside.contains(pixel)) return Visibility::kOpen;
  const float middle = depth.at<float>(pixel);
  if (middle > 0 && middle < (1 - kOcclusionMargin) * in_camera.z()) return Visibility::kOccluded;
  for (int y = pixel.y - radius; y <= pixel.y + radius; ++y) {
    const auto* row = depth.ptr<float>(y);
    for (int x = pixel.x - radius; x <= pixel.x + radius; ++x)
      if (row[x] <= (1 + kFreeSpaceMargin) * in_camera.z()) return Visibility::kOpen;
  }
  return Visibility::kFreeSpace;
}

void add(float log_odds, const Landmark& landmark, LandmarkEvidence& evidence) {
  const float known = landmark.static_log_odds;
  evidence.static_log_odds = std::clamp(known + evidence.static_log_odds + log_odds,
                                        -kMaxStaticLogOdds, kMaxStaticLogOdds) -
                             known;
}

}  // namespace

void add_static_evidence(const ObservedFrame& frame, const SparseMap& map,
                         std::span<const LandmarkId> visible, double seconds,
                         EvidenceByLandmark& evidence) {
  const auto share = static_cast<float>(std::clamp(kRate * seconds, kLeastShare, kMostShare));
  std::vector<bool> matched(map.landmark_id_end());
  for (std::size_t i = 0; i < frame.landmarks.size(); ++i) {
    const LandmarkId id = frame.landmarks[i];
    if (id == kNoId || frame.outlier[i]) continue;
    matched[id] = true;
    LandmarkEvidence& e = evidence[id];
    ++e.found;
    add(share * kInlierLogOdds * static_cast<float>(frame.track_weights[i]) / 255,
        *map.landmark(id), e);
  }
  const Pose camera_from_world = frame.world_from_camera.inverse();
  for (const LandmarkId id : visible) {
    const Landmark& landmark = *map.landmark(id);
    const Visibility seen =
        matched[id] ? Visibility::kOpen
                    : visibility(*frame.frame, camera_from_world * landmark.position_in_world);
    if (seen == Visibility::kOccluded) continue;
    LandmarkEvidence& e = evidence[id];
    ++e.visible;
    if (seen == Visibility::kFreeSpace) add(-share * kViolationLogOdds, landmark, e);
  }
}

int count_unoccluded(const ObservedFrame& frame, const SparseMap& map,
                     std::span<const LandmarkId> visible) {
  const Pose camera_from_world = frame.world_from_camera.inverse();
  return static_cast<int>(std::ranges::count_if(visible, [&](LandmarkId id) {
    return visibility(*frame.frame, camera_from_world * map.landmark(id)->position_in_world) !=
           Visibility::kOccluded;
  }));
}

}  // namespace stillpoint::orb_slam
