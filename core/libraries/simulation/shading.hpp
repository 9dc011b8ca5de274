// The colour of a surface where a ray meets it.
#pragma once

#include <vector>

#include "simulation/ray_caster.hpp"

namespace stillpoint::simulation {

/// How a surface is seen from here; pixels a few px apart on one surface share it.
struct Aspect {
  float infrared = 0;  ///< share of the depth sensor's light that comes back
  const Texture* texture = nullptr;
  TextureFilter filter;
};

class Shader {
 public:
  /// `pixel` is the size of a pixel at a distance of 1 m. Normals are those at `time`.
  Shader(const World& world, double time, float pixel);

  const Face& face(const Hit& hit) const {
    return (hit.body < 0 ? world_.room : world_.bodies[static_cast<std::size_t>(hit.body)].mesh)
        .faces[hit.face];
  }
  /// Two hits of the same surface have the same key, of different ones different keys. `face` is
  /// the hit's here and below.
  static std::int32_t surface_key(const Hit& hit, const Face& face) {
    return (hit.body + 1) << 16 | face.surface;
  }
  Aspect aspect(const Hit& hit, const Face& face, const Eigen::Vector3f& direction) const;
  /// b, g, r, 0…255 at normal exposure.
  Eigen::Vector3f color(const Hit& hit, const Face& face, const Aspect& aspect) const;

 private:
  Eigen::Vector3f normal(const Hit& hit, const Face& face) const;

  const World& world_;
  float pixel_;
  std::vector<Eigen::Matrix3f> world_from_body_;  // rotations
};

/// Remembers how the surface met last is seen: mostly, the next pixel shows it as well. For one
/// packet: further away, a surface is seen at another angle.
class AspectMemory {
 public:
  explicit AspectMemory(const Shader& shader) : shader_(shader) {}

  const Aspect& of(const Hit& hit, const Face& face, const Eigen::Vector3f& direction) {
    const std::int32_t key = Shader::surface_key(hit, face);
    if (key != key_) aspect_ = shader_.aspect(hit, face, direction);
    key_ = key;
    return aspect_;
  }

 private:
  const Shader& shader_;
  std::int32_t key_ = -1;
  Aspect aspect_;
};

}  // namespace stillpoint::simulation
