// The colour of a surface where a ray meets it.
#pragma once

#include <vector>

#include "simulation/ray_caster.hpp"

namespace stillpoint::simulation {

class Shader {
 public:
  /// `pixel` is the size of a pixel at a distance of 1 m. Normals are those at `time`.
  Shader(const World& world, double time, float pixel);

  const Face& face(const Hit& hit) const;
  /// b, g, r, 0…255 at normal exposure.
  Eigen::Vector3f shade(const Hit& hit, const Eigen::Vector3f& direction) const;
  /// Between ray and surface normal, [0, 1].
  float cosine(const Hit& hit, const Eigen::Vector3f& direction) const;

 private:
  Eigen::Vector3f normal(const Hit& hit, const Face& face) const;

  const World& world_;
  float pixel_;
  std::vector<Eigen::Matrix3f> world_from_body_;  // rotations
};

}  // namespace stillpoint::simulation
