// The recording that people are pasted into.
#pragma once

#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "evaluation/trajectory.hpp"
#include "people/plans.hpp"
#include "people/view.hpp"

namespace stillpoint::people {

/// A pair of images; times in seconds.
struct BasePair {
  double time = 0;
  std::filesystem::path color;
  double depth_time = 0;
  std::filesystem::path depth;
};

class BaseRecording {
 public:
  /// Throws Error(kData) when there is no associations.txt or groundtruth.txt in the folder.
  BaseRecording(const BasePlan& plan, const CameraModel& camera);

  const BasePlan& plan() const { return plan_; }
  const CameraModel& camera() const { return camera_; }
  const Rays& rays() const { return rays_; }
  const std::vector<BasePair>& pairs() const { return pairs_; }
  std::filesystem::path ground_truth() const;

  Pose world_from_camera(double time) const;

  cv::Mat color(const BasePair& pair) const;  ///< CV_8UC3
  cv::Mat depth(const BasePair& pair) const;  ///< CV_32FC1, metres, 0 = no measurement
  /// Class ids of what is known of the scene, as a source gives the images to the stages.
  cv::Mat labels(const BasePair& pair) const;

 private:
  cv::Mat desk_of(const BasePair& pair) const;

  BasePlan plan_;
  CameraModel camera_;
  Rays rays_;
  std::vector<BasePair> pairs_;
  evaluation::Trajectory truth_;
};

}  // namespace stillpoint::people
