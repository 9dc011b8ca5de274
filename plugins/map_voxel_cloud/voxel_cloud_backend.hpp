// Map back end `voxel_cloud`: a point cloud of voxels, quick to build and to move.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "map_voxel_cloud/voxel_cloud.hpp"
#include "stillpoint/sdk.hpp"

namespace stillpoint::map_voxel_cloud {

/// Every key frame keeps what it saw as a cloud of its own, in its camera's frame; they are put
/// together when the map is asked for. Moving key frames costs nothing.
class VoxelCloudBackend final : public MapBackend {
 public:
  struct Options {
    double resolution = 0.03;  ///< metres
    double range = 4.0;        ///< metres along z
    int min_points = 2;        ///< that a voxel needs
    int min_weight = 128;      ///< of StaticWeights::map

    void visit(OptionVisitor& visitor);
  };

  VoxelCloudBackend(const Options& options, const StageContext& context)
      : options_(options), classes_(context.classes) {}

  void integrate(const DenseKeyFrame& keyframe) override;
  void move(std::span<const MovedKeyFrame> moved) override;
  void clear() override { entries_.clear(); }
  void save(const std::filesystem::path& directory) override;
  std::vector<LabelledPoint> occupied() const override;

  /// All key frames at their current poses; without voxels of too few points.
  std::vector<VoxelPoint> points() const;

 private:
  struct Entry {
    Pose world_from_camera = Pose::Identity();
    std::vector<VoxelPoint> points;  // in the camera
  };

  Options options_;
  ClassNames classes_;
  std::map<KeyFrameId, Entry> entries_;
};

}  // namespace stillpoint::map_voxel_cloud
