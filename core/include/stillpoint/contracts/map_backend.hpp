// Contract: the dense map (paper III-E). Thread 5.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <vector>

#include "stillpoint/contracts/dense_keyframe.hpp"
#include "stillpoint/contracts/labelled_point.hpp"
#include "stillpoint/contracts/map_correction.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Calls never overlap. A DenseKeyFrame may be kept, with 2.5 MB of images of 640 × 480 px.
class STILLPOINT_EXPORT MapBackend {
 public:
  static constexpr const char* kKind = "map_backend";
  static constexpr std::uint32_t kApi = 3;  ///< see kPluginApi
  virtual ~MapBackend();

  /// Once per key frame, in order, after local mapping has refined it.
  virtual void integrate(const DenseKeyFrame& keyframe) = 0;
  /// Key frames that were moved by mapping or a loop closure, with their new poses; also such as
  /// have left the sparse map meanwhile, and those of a loaded map, which were never integrated.
  virtual void move(std::span<const MovedKeyFrame> moved) = 0;
  /// Forgets all key frames: a new map begins.
  virtual void clear() = 0;
  /// Writes the map's files into an existing folder; may bring the map up to date before. Called on
  /// any thread, at the end of a run, also of one that failed or was stopped, and in between. Not
  /// after this back end itself crashed or hung.
  virtual void save(const std::filesystem::path& directory) = 0;
  /// One point per occupied cell of the map so far. Empty for a map that is not made of points.
  /// Called on any thread, but never during another call.
  virtual std::vector<LabelledPoint> occupied() const;
};

}  // namespace stillpoint
