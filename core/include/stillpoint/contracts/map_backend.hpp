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

class STILLPOINT_EXPORT MapBackend {
 public:
  static constexpr const char* kKind = "map_backend";
  static constexpr std::uint32_t kApi = 1;  ///< see kPluginApi
  virtual ~MapBackend();

  virtual void integrate(const DenseKeyFrame& keyframe) = 0;
  /// Key frames that were moved by mapping or a loop closure.
  virtual void move(std::span<const MovedKeyFrame> moved) = 0;
  /// Writes the map's files into an existing folder; may bring the map up to date before.
  virtual void save(const std::filesystem::path& directory) = 0;
  /// One point per occupied cell of the map so far. Empty for a map that is not made of points.
  /// Called on any thread, but never during another call.
  virtual std::vector<LabelledPoint> occupied() const;
};

}  // namespace stillpoint
