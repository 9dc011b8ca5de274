// A saved map of the test room.
#pragma once

#include <memory>

#include "map_octomap/octomap_backend.hpp"
#include "map_octomap/test_room.hpp"

namespace stillpoint {

/// All around from the middle of the room, level and down to the floor.
inline std::unique_ptr<OctomapBackend> map_of(const TestRoom& room,
                                              const OctomapBackend::Options& options = {}) {
  StageContext context;
  context.classes = named_classes("voc21");
  auto map = std::make_unique<OctomapBackend>(options, context);
  for (KeyFrameId id = 0; id < 24; ++id) {
    Pose pose = looking({0.1, -0.4, 1.31}, 0.55 * id);
    if (id % 2 == 1) pose.rotate(Eigen::AngleAxisd(-0.8, Eigen::Vector3d::UnitX()));
    map->integrate(room.see(pose, id));
  }
  return map;
}

}  // namespace stillpoint
