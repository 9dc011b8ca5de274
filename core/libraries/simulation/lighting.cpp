#include "simulation/lighting.hpp"

#include <algorithm>
#include <cmath>

#include "simulation/noise.hpp"
#include "simulation/ray_caster.hpp"

namespace stillpoint::simulation {
namespace {

using Eigen::Vector3f;

constexpr float kOffSurface = 0.004F;  // metres, start of rays that leave a surface

/// Directions above a surface, denser where they count more (cosine law).
Vector3f hemisphere_direction(const Vector3f& normal, float a, float b) {
  const Vector3f tangent = normal.unitOrthogonal();
  const float radius = std::sqrt(a);
  const float angle = 2 * static_cast<float>(M_PI) * b;
  return radius * std::cos(angle) * tangent + radius * std::sin(angle) * normal.cross(tangent) +
         std::sqrt(std::max(0.0F, 1 - a)) * normal;
}

/// Share of the surroundings that is open, [0, 1].
float openness(const RayCaster& caster, const Vector3f& point, const Vector3f& normal,
               const RowNoise& noise) {
  constexpr int kRays = 24;
  constexpr float kReach = 0.9F;  // metres; what is farther does not darken
  int open = 0;
  for (int i = 0; i < kRays; ++i) {
    const float a = (static_cast<float>(i) + noise.uniform(2 * i)) / kRays;
    const Vector3f direction = hemisphere_direction(normal, a, noise.uniform(2 * i + 1));
    if (!caster.occluded(point, direction, kReach)) ++open;
  }
  return static_cast<float>(open) / kRays;
}

float lamplight(const RayCaster& caster, const std::vector<Lamp>& lamps, const Vector3f& point,
                const Vector3f& normal) {
  constexpr int kSamples = 3;      // along the longer side of a lamp
  constexpr float kReach = 11.0F;  // metres; what is farther adds less than a 300th
  float sum = 0;
  for (const Lamp& lamp : lamps) {
    if ((lamp.centre - point).squaredNorm() > kReach * kReach) continue;
    for (int i = 0; i < kSamples; ++i) {
      const float along = (static_cast<float>(i) + 0.5F) / kSamples - 0.5F;
      const Vector3f source =
          lamp.centre + Vector3f(along * lamp.size.x(), along * lamp.size.y(), -0.02F);
      const Vector3f way = source - point;
      const float distance = way.norm();
      const float cosine = normal.dot(way) / distance;
      if (cosine <= 0 || way.z() <= 0) continue;
      if (caster.occluded(point, way / distance, distance - 0.02F)) continue;
      sum += cosine * way.z() / distance / std::max(distance * distance, 0.2F);
    }
  }
  return sum / kSamples;
}

}  // namespace

void light_room(World& world) {
  constexpr float kAmbient = 0.85F;
  constexpr float kLamp = 0.85F;
  const RayCaster caster(world.room);
  std::vector<float> light(world.room.vertices.size(), -1.0F);
  for (std::size_t i = 0; i < world.room.faces.size(); ++i) {
    Face& face = world.room.faces[i];
    if (face.glows) continue;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t id = world.room.triangles[i][k];
      if (light[id] < 0) {
        const Vector3f point = world.room.vertices[id] + kOffSurface * face.normal[k];
        const RowNoise noise(1, 0, Stream::kColor, static_cast<int>(id));
        light[id] = kAmbient * openness(caster, point, face.normal[k], noise) + 0.28F +
                    kLamp * lamplight(caster, world.lamps, point, face.normal[k]);
      }
      face.light[k] = light[id];
    }
  }
}

float light_on_body(const Eigen::Vector3f& normal) {
  return 1.08F + 0.45F * normal.z() - 0.12F * normal.y();
}

}  // namespace stillpoint::simulation
