// For tests of plugins: a short recording whose truth is known.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "stillpoint/contracts/dense_keyframe.hpp"
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/contracts/keyframe.hpp"
#include "stillpoint/contracts/moving_points.hpp"
#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/contracts/static_weights.hpp"
#include "stillpoint/export.hpp"
#include "stillpoint/plugin.hpp"

namespace stillpoint::testing {

struct TestRecordingOptions {
  int frames = 20;
  int width = 320;                  ///< px
  int height = 240;                 ///< px
  double frames_per_second = 30.0;  ///< of the time stamps
  double metres_per_second = 0.5;   ///< of the camera; 0: it stands still
  bool person = true;               ///< whether somebody walks through the picture
  std::uint32_t first_index = 0;    ///< of the frames
  double depth_noise = 0.0;         ///< metres at 1 m, see Camera::surface_noise
  std::uint64_t seed = 1;           ///< of texture and noise
};

/// A furnished room (6 m × 3 m × 6 m) with texture on every surface, a camera that moves sideways
/// and turns, and a person, two spheres one above the other, who walks across at 1 m/s, 2 m away.
/// Rendered exactly, without lens distortion; world is the first camera's frame. All of it is made
/// in the constructor, some 20 ms per frame of the usual size; safe to read from any thread.
class STILLPOINT_EXPORT TestRecording {
 public:
  explicit TestRecording(const TestRecordingOptions& options = {});

  std::size_t size() const { return views_.size(); }
  const Camera& camera() const { return *camera_; }
  /// What the labels mean: background, person.
  static ClassNames classes() { return {"background", "person"}; }

  FramePtr frame(std::size_t i) const { return views_.at(i).frame; }
  Pose world_from_camera(std::size_t i) const { return views_.at(i).world_from_camera; }
  /// The true labels, with their objects.
  SegmentationPtr segmentation(std::size_t i) const { return views_.at(i).segmentation; }
  /// 0 on the person, 255 elsewhere, for tracking and mapping.
  std::shared_ptr<const StaticWeights> weights(std::size_t i) const { return views_.at(i).weights; }
  /// Points on a grid of 16 px in frame i - 1, followed exactly to frame i; none for i = 0.
  MovingPoints moving_points(std::size_t i) const;
  /// The key frame that orb_keyframe() makes of it, at the true pose.
  KeyFrame keyframe(std::size_t i, KeyFrameId id) const;
  DenseKeyFrame dense_keyframe(std::size_t i, KeyFrameId id) const;

 private:
  struct View {
    FramePtr frame;
    SegmentationPtr segmentation;
    std::shared_ptr<const StaticWeights> weights;
    Pose world_from_camera;
    Eigen::Vector3d person;  // in world
  };

  View view_at(int i, const TestRecordingOptions& options) const;

  std::shared_ptr<const Camera> camera_;
  std::vector<View> views_;
};

/// A key frame with ORB features, their depth and their weights, and without landmarks.
STILLPOINT_EXPORT KeyFrame orb_keyframe(const Frame& frame, const StaticWeights& weights,
                                        const Pose& world_from_camera, KeyFrameId id);

/// A context as the program makes one, for a pipeline with the classes of a TestRecording.
/// Messages of warning and worse are printed.
STILLPOINT_EXPORT StageContext test_context();

}  // namespace stillpoint::testing
