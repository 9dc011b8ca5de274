#include "stillpoint/runtime/thorough_checks.hpp"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <opencv2/core.hpp>
#include <string>

#include "stillpoint/error.hpp"
#include "stillpoint/runtime/stage_requirement.hpp"

namespace stillpoint {
namespace {

std::string text_of(const cv::Point& pixel) {
  return std::to_string(pixel.x) + ", " + std::to_string(pixel.y);
}

/// Also refuses what is no number.
void require_range(const cv::Mat& image, double least, double most, const std::string& what,
                   const std::string& remedy) {
  if (image.empty()) return;
  cv::Mat inside;
  cv::inRange(image, least, most, inside);
  double least_inside = 0;
  cv::Point outside;
  cv::minMaxLoc(inside, &least_inside, nullptr, &outside);
  require_of_stage(
      least_inside > 0,
      what + " at " + text_of(outside) + " is " + std::to_string(image.at<float>(outside)), remedy);
}

}  // namespace

void check_thoroughly(const Frame& frame) {
  require_range(frame.depth, 0, FLT_MAX, "the depth", "0 stands for no measurement");
}

void check_thoroughly(const MovingPoints& moving) {
  require_of_stage(
      std::ranges::all_of(moving.points, [](const auto& p) { return std::isfinite(p.residual); }),
      "the residual of a point is no number", "give 0 where there is none");
}

void check_thoroughly(const MapEvidence& evidence) {
  require_range(evidence.log_odds, -FLT_MAX, FLT_MAX, "the evidence",
                "0 stands for what is not known");
}

void check_thoroughly(const TrackResult& result) {
  if (result.state != TrackState::kTracking || !result.uncertainty) return;
  const Matrix6d& covariance = result.uncertainty->covariance;
  require_of_stage(covariance.allFinite() && covariance.diagonal().minCoeff() >= 0,
                   "the uncertainty of the pose is no covariance",
                   "leave TrackResult::uncertainty empty where it is not known");
}

void check_thoroughly(const SparseMap& map) {
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    if (const KeyFrame* keyframe = map.keyframe(id))
      require_of_stage(keyframe->world_from_camera.matrix().allFinite(),
                       "the pose of key frame " + std::to_string(id) + " is no number", "");
  for (LandmarkId id = 0; id < map.landmark_id_end(); ++id)
    if (const Landmark* landmark = map.landmark(id))
      require_of_stage(landmark->position_in_world.allFinite(),
                       "the position of landmark " + std::to_string(id) + " is no number", "");
  if (const auto fault = map.check())
    throw Error(Fault::kStage, "the map does not hold together: " + *fault, "",
                "use MapEdit, which keeps both sides of each link");
}

}  // namespace stillpoint
