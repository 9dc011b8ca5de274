// The nearest surface along rays, with Embree.
#pragma once

#include <array>
#include <memory>
#include <span>

#include "simulation/world.hpp"

namespace stillpoint::simulation {

inline constexpr int kPacket = 8;  ///< rays cast at once

/// Directions of one packet, not normalised: distances are multiples of their length.
struct RayPacket {
  alignas(32) std::array<float, kPacket> x;
  alignas(32) std::array<float, kPacket> y;
  alignas(32) std::array<float, kPacket> z;
};

struct Hit {
  float distance = 0;      ///< multiples of the direction; 0 = nothing there
  std::int32_t body = -1;  ///< index into World::bodies; -1 = the room
  std::uint32_t face = 0;  ///< of the mesh
  float u = 0;             ///< weight of the face's second corner
  float v = 0;             ///< weight of the face's third corner
};

/// The world must outlive the caster. Casting is const and may be done by several threads. Throws
/// Error(kStage) where Embree fails or would have too little memory.
class RayCaster {
 public:
  explicit RayCaster(const World& world);
  /// A mesh alone, as body -1.
  explicit RayCaster(const Mesh& mesh);
  ~RayCaster();

  /// Puts the bodies where they are from `begin` to `end` (seconds from the first frame); rays then
  /// choose a moment in between.
  void pose_bodies(double begin, double end);

  enum class Targets { kRoom, kAll };
  /// `moment` in [0, 1], from begin to end.
  void cast(const Eigen::Vector3f& origin, const RayPacket& directions, float moment,
            Targets targets, std::span<Hit, kPacket> hits) const;

  /// Whether the room is nearer than `reach` along a unit vector.
  bool occluded(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float reach) const;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace stillpoint::simulation
