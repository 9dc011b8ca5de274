// Map back end `height_map`: how high the ground is, cell by cell, for robots that drive.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <string_view>
#include <vector>

#include "height_grid.hpp"

/// Each key frame keeps its points in the frame of its camera, so that the map follows when key
/// frames are moved; the grid is made when the map is saved.
class HeightMap final : public stillpoint::MapBackend {
 public:
  struct Options {
    GridOptions grid;
    double range = 4.0;  ///< metres along z
    int step = 4;        ///< px

    void visit(stillpoint::OptionVisitor& v);
  };
  HeightMap(Options options, const stillpoint::StageContext& context)
      : options_(options), log_(context.log) {}

  void integrate(const stillpoint::DenseKeyFrame& keyframe) override;
  void move(std::span<const stillpoint::MovedKeyFrame> moved) override;
  void clear() override { views_.clear(); }
  /// Without a floor in view there is a warning, and no file.
  void save(const std::filesystem::path& directory) override;

  /// Nothing when no floor is in view.
  std::optional<HeightGrid> grid() const;

 private:
  struct Point {
    Eigen::Vector3f in_camera = Eigen::Vector3f::Zero();  // metres
    bool faces_up = false;                                // it may be on the floor
  };
  struct View {
    stillpoint::Pose world_from_camera = stillpoint::Pose::Identity();
    std::vector<Point> points;
  };

  Options options_;
  std::function<void(stillpoint::LogLevel, std::string_view)> log_;
  std::map<stillpoint::KeyFrameId, View> views_;
};
