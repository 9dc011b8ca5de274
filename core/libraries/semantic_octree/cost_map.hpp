// The map as a robot on the floor needs it: where it may drive, in the format of ROS's map_server.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <filesystem>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "semantic_octree/floor_plane.hpp"
#include "semantic_octree/semantic_octree.hpp"
#include "stillpoint/contracts/frame.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint::semantic_octree {

struct CostMapOptions {
  double from = 0.1;  ///< metres above the floor: what is lower is driven over; at least a voxel
  double to = 1.8;    ///< metres above the floor: what is higher is driven under
  double robot_radius = 0.0;  ///< metres by which obstacles grow
  /// Nothing: the floor is found. Three numbers: x, y, z of the upward direction in the world, from
  /// gravity; only the floor's height is found. Four: its height along that direction as well.
  std::vector<double> floor;

  void visit(OptionVisitor& visitor);
  /// Whether these numbers can be `floor`.
  static bool is_floor(const std::vector<double>& numbers);
};

/// Cells of the tree's resolution in the floor's frame: x and y on the floor, z up, the origin
/// below that of the world, x along the world's z axis as far as it is horizontal, which is where
/// the first camera looks.
struct CostMap {
  static constexpr std::uint8_t kOccupied = 0, kUnknown = 205, kFree = 254;

  cv::Mat cells;                 ///< CV_8UC1; first row: largest y
  double resolution = 0;         ///< metres
  Eigen::Vector2d corner{0, 0};  ///< lower left, metres in the floor's frame
  Pose floor_from_world = Pose::Identity();

  /// Cell of a point in the world; may lie outside.
  cv::Point cell_of(const Eigen::Vector3d& point_in_world) const;
};

/// The floor that the options name or that lies under the occupied voxels, if there is one. The
/// first camera, whose frame is the world, was held upright to within 50°.
std::optional<FloorPlane> floor_of(const SemanticOctree& tree, const CostMapOptions& options);

/// Occupied: a voxel between the two heights is, in a connected group of at least 2 dm² of surface
/// that more than one key frame has seen. Free: no group of that size is there, at least half of
/// the space between the heights was seen to be free, and so was its lower end, or the floor itself
/// was seen, so that there is no low obstacle. All else is unknown. Throws Error(kData) for a map
/// so wide that it would have more than 10⁸ cells.
CostMap project(const SemanticOctree& tree, const FloorPlane& floor, const CostMapOptions& options);

/// `stem`.pgm and `stem`.yaml (mode trinary; besides map_server's keys `world_from_map`: position
/// x, y, z and quaternion x, y, z, w of the floor's frame). Both are whole or not there; errors
/// throw Error(kUsage).
void write_cost_map(const CostMap& map, const std::filesystem::path& stem);

}  // namespace stillpoint::semantic_octree
