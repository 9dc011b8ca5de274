// What there is to see: a room that stands still and bodies that move as functions of time.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "simulation/album.hpp"
#include "simulation/mesh.hpp"
#include "simulation/scene_options.hpp"
#include "simulation/texture.hpp"

namespace stillpoint::simulation {

/// A rigid thing that moves. `time` in seconds from the first frame.
struct Body {
  Mesh mesh;
  std::function<Eigen::Affine3d(double time)> world_from_body;
};

/// A bright rectangle of the ceiling, facing down.
struct Lamp {
  Eigen::Vector3f centre;
  Eigen::Vector2f size;
};

struct World {
  std::shared_ptr<const Album> album;  ///< to paint the room with; null: none
  std::vector<Texture> textures;
  std::vector<Lamp> lamps;
  Mesh room;
  std::vector<Body> bodies;

  std::uint16_t add_texture(Texture texture);
  /// A number of its own for each thing in the instance images.
  std::uint8_t add_instance();

 private:
  int instances_ = 0;
};

/// The room, what stands in it, people and balls, and the light on what does not move. What moves
/// comes last, so that a scene without people has the same room.
World build_world(const SceneOptions& scene);

}  // namespace stillpoint::simulation
