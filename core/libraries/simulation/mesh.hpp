// Triangle meshes with what shading needs, and the few shapes rooms and people are made of.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

namespace stillpoint::simulation {

/// PASCAL VOC class ids, as segmentation networks use them.
enum VocLabel : std::uint8_t {
  kBackground = 0,
  kBottle = 5,
  kChair = 9,
  kDiningTable = 11,
  kPerson = 15,
  kPottedPlant = 16,
  kSofa = 18,
  kTvMonitor = 20,
};

/// What a shape is made of and what it is.
struct Skin {
  std::uint16_t texture = 0;              ///< index into World::textures
  std::uint8_t label = kBackground;       ///< VocLabel
  std::uint8_t instance = 0;              ///< 0 = none
  Eigen::Vector2f offset = {0.0F, 0.0F};  ///< metres, of the texture on the surface
  bool glows = false;                     ///< shines by itself: lamps, screens
};

/// One triangle, with everything that shading needs close together in memory.
struct Face {
  std::array<Eigen::Vector3f, 3> normal;   ///< at the corners, unit length
  std::array<Eigen::Vector2f, 3> uv;       ///< at the corners, metres on the texture
  std::array<float, 3> light = {1, 1, 1};  ///< at the corners, baked for what does not move
  Eigen::Vector3f tangent;                 ///< direction of growing u
  std::uint16_t texture = 0;
  std::uint16_t surface = 0;  ///< same for all faces of one smooth shape
  std::uint8_t label = 0;
  std::uint8_t instance = 0;
  bool glows = false;
};

struct Mesh {
  std::vector<Eigen::Vector3f> vertices;  ///< metres
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<Face> faces;  ///< one per triangle
  std::uint16_t surfaces = 0;
};

/// A parallelogram seen from the side on which `right` and `down` are right and down. Divided into
/// cells no larger than `cell` metres, for the light at their corners.
void add_panel(Mesh& mesh, const Eigen::Vector3f& top_left, const Eigen::Vector3f& right,
               const Eigen::Vector3f& down, const Skin& skin, float cell = 0.2F);

/// A box of `size` metres, centred on the origin of `pose`.
void add_box(Mesh& mesh, const Eigen::Affine3f& pose, const Eigen::Vector3f& size, const Skin& skin,
             float cell = 0.2F);

/// Cross-section of a loft: an ellipse around `centre`, parallel to the x-y plane of its pose.
struct Ring {
  Eigen::Vector3f centre;
  float radius_x;
  float radius_y;
};

/// The smooth skin over two or more rings, in order of growing z; closed where radii end at 0.
void add_loft(Mesh& mesh, const Eigen::Affine3f& pose, const std::vector<Ring>& rings,
              const Skin& skin, int segments = 20);

/// Rings of an ellipsoid.
std::vector<Ring> ellipsoid(const Eigen::Vector3f& centre, const Eigen::Vector3f& radii,
                            int count = 13);

/// Rings of a limb from the origin down to (0, 0, -length): two half spheres and what is between.
std::vector<Ring> limb(float length, float radius_top, float radius_middle, float radius_bottom);

}  // namespace stillpoint::simulation
