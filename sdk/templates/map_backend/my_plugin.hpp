// Map backend `my_plugin`: a point cloud, one point per voxel.
#pragma once

#include <map>
#include <stillpoint/sdk.hpp>
#include <vector>

namespace plugins::my_plugin {

class MyPlugin final : public stillpoint::MapBackend {
 public:
  struct Options {
    double voxel = 0.03;
    double max_depth = 5.0;
    int step = 2;

    void visit(stillpoint::OptionVisitor& v) {
      v("voxel", voxel, {.min = 0.001, .max = 10, .unit = "m", .help = "side of a voxel"});
      v("max_depth", max_depth, {.min = 0.1, .unit = "m", .help = "farther points are left out"});
      v("step", step, {.min = 1, .max = 64, .unit = "px", .help = "between pixels that are used"});
    }
  };

  MyPlugin(Options options, const stillpoint::StageContext& context)
      : options_(options), classes_(context.classes) {}

  void integrate(const stillpoint::DenseKeyFrame& keyframe) override;
  void move(std::span<const stillpoint::MovedKeyFrame> moved) override;
  void clear() override { views_.clear(); }
  void save(const std::filesystem::path& directory) override;
  std::vector<stillpoint::LabelledPoint> occupied() const override;

 private:
  /// Points stay in the camera's frame, so that a key frame can be moved.
  struct View {
    stillpoint::Pose world_from_camera = stillpoint::Pose::Identity();
    std::vector<stillpoint::LabelledPoint> in_camera;
  };

  Options options_;
  stillpoint::ClassNames classes_;
  std::map<stillpoint::KeyFrameId, View> views_;
};

}  // namespace plugins::my_plugin
