#include "simulation/shading.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/lighting.hpp"

namespace stillpoint::simulation {

using Eigen::Vector2f;
using Eigen::Vector3f;

Shader::Shader(const World& world, double time, float pixel) : world_(world), pixel_(pixel) {
  for (const Body& body : world.bodies)
    world_from_body_.push_back(body.world_from_body(time).linear().cast<float>());
}

Vector3f Shader::normal(const Hit& hit, const Face& face) const {
  // Corners' normals are close to each other: what is between is as good as normalised.
  const Vector3f n =
      (1 - hit.u - hit.v) * face.normal[0] + hit.u * face.normal[1] + hit.v * face.normal[2];
  return hit.body < 0 ? n : world_from_body_[static_cast<std::size_t>(hit.body)] * n;
}

Aspect Shader::aspect(const Hit& hit, const Face& f, const Vector3f& direction) const {
  constexpr float kGrazing = 0.08F;  // footprints grow no longer than 1 / this
  const Vector3f n = normal(hit, f);
  const float cosine = std::abs(n.dot(direction)) / direction.norm();
  const Vector3f tangent =
      hit.body < 0 ? f.tangent : world_from_body_[static_cast<std::size_t>(hit.body)] * f.tangent;
  const Vector3f along = direction - n * n.dot(direction);
  const Vector2f along_uv(along.dot(tangent), along.dot(tangent.cross(n)));
  const float size = hit.distance * pixel_;
  const float length = along_uv.norm();
  Footprint footprint{Vector2f::Zero(), size};
  if (length > 1e-6F)
    footprint.major = along_uv * (0.5F * size / std::max(cosine, kGrazing) / length);
  const Texture& texture = world_.textures[f.texture];
  return {cosine * texture.infrared(), &texture, texture.filter(footprint)};
}

Vector3f Shader::color(const Hit& hit, const Face& f, const Aspect& aspect) const {
  const float w = 1 - hit.u - hit.v;
  const Vector2f uv = w * f.uv[0] + hit.u * f.uv[1] + hit.v * f.uv[2];
  const float light = f.glows        ? 1.0F
                      : hit.body < 0 ? w * f.light[0] + hit.u * f.light[1] + hit.v * f.light[2]
                                     : light_on_body(normal(hit, f));
  return aspect.texture->sample(uv, aspect.filter) * light;
}

}  // namespace stillpoint::simulation
