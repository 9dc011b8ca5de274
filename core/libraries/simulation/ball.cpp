#include "simulation/ball.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/painting.hpp"

namespace stillpoint::simulation {

Eigen::Vector3d ball_position(const BallOptions& options, double time) {
  constexpr double kGravity = 9.81;  // m/s²
  const double period = options.flight + options.pause;
  const double throws = std::floor(time / period);
  const double in_flight = std::min(time - throws * period, options.flight);
  Eigen::Vector3d from(options.from.data());
  Eigen::Vector3d to(options.to.data());
  if (std::fmod(std::abs(throws), 2) == 1) std::swap(from, to);
  const double height = 0.5 * kGravity * in_flight * (options.flight - in_flight);
  return from + (to - from) * in_flight / options.flight + height * Eigen::Vector3d::UnitZ();
}

void add_ball(World& world, const BallOptions& options) {
  const auto radius = static_cast<float>(options.radius);
  const Skin skin{.texture = world.add_texture({Painter(5).ball({512, 512}), {0.4F, 0.4F}}),
                  .instance = world.add_instance()};
  Body body;
  add_loft(body.mesh, Eigen::Affine3f::Identity(),
           ellipsoid({0, 0, 0}, {radius, radius, radius}, 17), skin, 32);
  body.world_from_body = [options](double time) {
    Eigen::Affine3d pose = Eigen::Affine3d::Identity();
    pose.linear() =
        Eigen::AngleAxisd(5.0 * time, Eigen::Vector3d(0.6, 0.64, 0.48)).toRotationMatrix();
    pose.translation() = ball_position(options, time);
    return pose;
  };
  world.bodies.push_back(std::move(body));
}

}  // namespace stillpoint::simulation
