#include "simulation/shell.hpp"

#include "simulation/painting.hpp"

namespace stillpoint::simulation {

using Eigen::Vector3f;

namespace {

/// The picture with `contrast` times its differences from its mean colour.
cv::Mat faded(const cv::Mat& image, double contrast) {
  if (contrast == 1) return image;
  const cv::Mat even(image.size(), image.type(), cv::mean(image));
  cv::Mat result;
  cv::addWeighted(image, contrast, even, 1 - contrast, 0, result);
  return result;
}

}  // namespace

ShellSkins shell_skins(World& world, const RoomOptions& options) {
  Painter painter(options.seed, world.album);
  const auto covered = [&](const cv::Mat& image, Eigen::Vector2f size, float infrared = 1.0F) {
    return world.add_texture({faded(image, options.texture), size, infrared});
  };
  const auto wall = [&](cv::Scalar color) {
    return Skin{.texture = covered(painter.plaster({2048, 1024}, color, 0.035), {6.0F, 3.0F})};
  };
  ShellSkins skins;
  skins.floor.texture = covered(painter.carpet({2048, 2048}), {3.5F, 3.5F}, 0.9F);
  skins.ceiling.texture = covered(painter.ceiling({512, 512}), {0.6F, 0.6F});
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
