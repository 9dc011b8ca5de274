#include "simulation/world.hpp"

#include <utility>

#include "simulation/ball.hpp"
#include "simulation/corridor.hpp"
#include "simulation/lighting.hpp"
#include "simulation/person.hpp"
#include "simulation/room.hpp"
#include "simulation/suite.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::simulation {

std::uint16_t World::add_texture(Texture texture) {
  textures.push_back(std::move(texture));
  return static_cast<std::uint16_t>(textures.size() - 1);
}

std::uint8_t World::add_instance() {
  if (instances_ == 255)
    throw Error(Fault::kUsage, "more than 255 things do not fit into 8-bit instance images",
                "simulation", "leave out some people or balls");
  return static_cast<std::uint8_t>(++instances_);
}

World build_world(const SceneOptions& scene) {
  World world;
  if (!scene.room.photographs.empty())
    world.album = std::make_shared<const Album>(scene.room.photographs);
  switch (scene.room.plan) {
    case RoomOptions::Plan::kOffice:
      add_room(world, scene.room);
      break;
    case RoomOptions::Plan::kSuite:
      add_suite(world, scene.room);
      break;
    case RoomOptions::Plan::kCorridor:
      add_corridor(world, scene.room);
      break;
  }
  light_room(world);
  for (const PersonOptions& person : scene.people) add_person(world, person);
  for (const BallOptions& ball : scene.balls) add_ball(world, ball);
  return world;
}

}  // namespace stillpoint::simulation
