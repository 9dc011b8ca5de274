#include "simulation/shell.hpp"

#include "simulation/painting.hpp"

namespace stillpoint::simulation {

using Eigen::Vector3f;

ShellSkins shell_skins(World& world, int seed) {
  Painter painter(seed, world.album);
  const auto wall = [&](cv::Scalar color) {
    const cv::Mat image = painter.plaster({2048, 1024}, color, 0.035);
    return Skin{.texture = world.add_texture({image, {6.0F, 3.0F}})};
  };
  ShellSkins skins;
  skins.floor.texture = world.add_texture({painter.carpet({2048, 2048}), {3.5F, 3.5F}, 0.9F});
  skins.ceiling.texture = world.add_texture({painter.ceiling({512, 512}), {0.6F, 0.6F}});
  skins.pale = wall({205, 212, 214});
  skins.grey = wall({176, 172, 165});
  const cv::Mat white(16, 16, CV_8UC3, cv::Scalar(255, 255, 255));
  skins.tube = {.texture = world.add_texture({white, {1, 1}}), .glows = true};
  return skins;
}

void add_lamp(World& world, const Skin& tube, const Vector3f& place) {
  const Lamp lamp{place - Vector3f(0, 0, 0.03F), {0.25F, 1.2F}};
  world.lamps.push_back(lamp);
  add_panel(world.room, lamp.centre - Vector3f(lamp.size.x() / 2, lamp.size.y() / 2, 0),
            {lamp.size.x(), 0, 0}, {0, lamp.size.y(), 0}, tube);
}

}  // namespace stillpoint::simulation
