// A key frame that the dense map keeps, to be fused again when it has moved.
#pragma once

#include <memory>
#include <string>

#include "stillpoint/contracts/map_backend.hpp"

namespace stillpoint::map_octomap {

/// Every `stride`-th pixel of a key frame in both directions, compressed without loss but for
/// depth, which is rounded to 0.2 mm and ends at 13.1 m.
class StoredKeyFrame {
 public:
  StoredKeyFrame(const DenseKeyFrame& keyframe, int stride);

  std::size_t bytes() const { return packed_.size(); }
  /// With a camera of as many pixels. The pose is the caller's.
  DenseKeyFrame unpack(const Pose& world_from_camera) const;

 private:
  KeyFrameId id_;
  std::uint32_t frame_;
  double time_;
  bool labelled_;
  std::shared_ptr<const Camera> camera_;  // of the pixels kept
  std::string packed_;
};

}  // namespace stillpoint::map_octomap
