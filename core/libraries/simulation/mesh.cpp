#include "simulation/mesh.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::simulation {
namespace {

struct Corner {
  Eigen::Vector3f position;
  Eigen::Vector3f normal;
  Eigen::Vector2f uv;
};

/// A grid of corners becomes vertices and two triangles per cell.
void add_grid(Mesh& mesh, const std::vector<Corner>& corners, int columns, const Skin& skin) {
  const auto base = static_cast<std::uint32_t>(mesh.vertices.size());
  const auto rows = static_cast<int>(corners.size()) / columns;
  for (const Corner& c : corners) mesh.vertices.push_back(c.position);
  const auto add = [&](int a, int b, int c) {
    Face face{.normal = {},
              .uv = {},
              .tangent = {},
              .texture = skin.texture,
              .surface = mesh.surfaces,
              .label = skin.label,
              .instance = skin.instance,
              .glows = skin.glows};
    const std::array<int, 3> ids = {a, b, c};
    for (std::size_t i = 0; i < 3; ++i) {
      const Corner& corner = corners[static_cast<std::size_t>(ids[i])];
      face.normal[i] = corner.normal;
      face.uv[i] = corner.uv + skin.offset;
    }
    const Eigen::Vector3f e1 = mesh.vertices[base + b] - mesh.vertices[base + a];
    const Eigen::Vector3f e2 = mesh.vertices[base + c] - mesh.vertices[base + a];
    const Eigen::Vector2f d1 = face.uv[1] - face.uv[0];
    const Eigen::Vector2f d2 = face.uv[2] - face.uv[0];
    const float determinant = d1.x() * d2.y() - d2.x() * d1.y();
    face.tangent = ((e1 * d2.y() - e2 * d1.y()) * (determinant < 0 ? -1.0F : 1.0F)).normalized();
    mesh.triangles.push_back({base + a, base + b, base + c});
    mesh.faces.push_back(face);
  };
  for (int row = 0; row + 1 < rows; ++row) {
    for (int column = 0; column + 1 < columns; ++column) {
      const int i = row * columns + column;
      add(i, i + 1, i + columns);
      add(i + 1, i + columns + 1, i + columns);
    }
  }
  ++mesh.surfaces;
}

/// Outward normal of a loft at ring `i`, direction (cosine, sine), from the slope of its profile.
Eigen::Vector3f loft_normal(const std::vector<Ring>& rings, std::size_t i, float cosine,
                            float sine) {
  const Ring& low = rings[i == 0 ? 0 : i - 1];
  const Ring& high = rings[std::min(i + 1, rings.size() - 1)];
  const auto on = [&](const Ring& ring) {
    return Eigen::Vector3f(ring.centre +
                           Eigen::Vector3f(ring.radius_x * cosine, ring.radius_y * sine, 0));
  };
  const Ring& here = rings[i];
  const Eigen::Vector3f around(-std::max(here.radius_x, 1e-4F) * sine,
                               std::max(here.radius_y, 1e-4F) * cosine, 0);
  const Eigen::Vector3f up = on(high) - on(low);
  const Eigen::Vector3f normal = around.cross(up);
  const float norm = normal.norm();
  return norm > 1e-12F ? Eigen::Vector3f(normal / norm) : Eigen::Vector3f::UnitZ();
}

}  // namespace

void add_panel(Mesh& mesh, const Eigen::Vector3f& top_left, const Eigen::Vector3f& right,
               const Eigen::Vector3f& down, const Skin& skin, float cell) {
  const float width = right.norm();
  const float height = down.norm();
  const int columns = static_cast<int>(std::ceil(width / cell)) + 1;
  const int rows = static_cast<int>(std::ceil(height / cell)) + 1;
  const Eigen::Vector3f normal = down.cross(right).normalized();
  std::vector<Corner> corners;
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const float a = static_cast<float>(column) / static_cast<float>(columns - 1);
      const float b = static_cast<float>(row) / static_cast<float>(rows - 1);
      corners.push_back({top_left + a * right + b * down, normal, {a * width, b * height}});
    }
  }
  add_grid(mesh, corners, columns, skin);
}

void add_box(Mesh& mesh, const Eigen::Affine3f& pose, const Eigen::Vector3f& size, const Skin& skin,
             float cell) {
  const Eigen::Vector3f h = 0.5F * size;
  const auto panel = [&](const Eigen::Vector3f& a, const Eigen::Vector3f& right,
                         const Eigen::Vector3f& down) {
    add_panel(mesh, pose * a, pose.linear() * right, pose.linear() * down, skin, cell);
  };
  const Eigen::Vector3f x(size.x(), 0, 0);
  const Eigen::Vector3f y(0, size.y(), 0);
  const Eigen::Vector3f z(0, 0, size.z());
  panel({-h.x(), -h.y(), h.z()}, x, -z);  // front, towards -y
  panel({h.x(), h.y(), h.z()}, -x, -z);   // back
  panel({-h.x(), h.y(), h.z()}, -y, -z);  // left, towards -x
  panel({h.x(), -h.y(), h.z()}, y, -z);   // right
  panel({-h.x(), h.y(), h.z()}, x, -y);   // top
  panel({-h.x(), -h.y(), -h.z()}, x, y);  // bottom
}

void add_loft(Mesh& mesh, const Eigen::Affine3f& pose, const std::vector<Ring>& rings,
              const Skin& skin, int segments) {
  float radius = 0;
  for (const Ring& ring : rings) radius = std::max({radius, ring.radius_x, ring.radius_y});
  std::vector<Corner> corners;
  float along = 0;
  for (std::size_t i = 0; i < rings.size(); ++i) {
    const Ring& ring = rings[i];
    if (i > 0) {
      along += std::hypot((ring.centre - rings[i - 1].centre).norm(),
                          ring.radius_x - rings[i - 1].radius_x);
    }
    for (int s = 0; s <= segments; ++s) {
      const float angle = 2 * static_cast<float>(M_PI) * static_cast<float>(s % segments) /
                          static_cast<float>(segments);
      const float cosine = std::cos(angle);
      const float sine = std::sin(angle);
      const Eigen::Vector3f point =
          ring.centre + Eigen::Vector3f(ring.radius_x * cosine, ring.radius_y * sine, 0);
      const float u = 2 * static_cast<float>(M_PI) * radius * static_cast<float>(s) /
                      static_cast<float>(segments);
      corners.push_back(
          {pose * point, pose.linear() * loft_normal(rings, i, cosine, sine), {u, -along}});
    }
  }
  add_grid(mesh, corners, segments + 1, skin);
}

std::vector<Ring> ellipsoid(const Eigen::Vector3f& centre, const Eigen::Vector3f& radii,
                            int count) {
  std::vector<Ring> rings;
  for (int i = 0; i < count; ++i) {
    const float angle =
        static_cast<float>(M_PI) * static_cast<float>(i) / static_cast<float>(count - 1);
    const float sine = i == 0 || i == count - 1 ? 0 : std::sin(angle);
    rings.push_back({centre - Eigen::Vector3f(0, 0, radii.z() * std::cos(angle)), radii.x() * sine,
                     radii.y() * sine});
  }
  return rings;
}

std::vector<Ring> limb(float length, float radius_top, float radius_middle, float radius_bottom) {
  std::vector<Ring> rings;
  const auto cap = [&](float z, float radius, float from, float to) {
    for (int i = 0; i <= 4; ++i) {
      const float angle = from + (to - from) * static_cast<float>(i) / 4;
      const float wide = radius * std::max(0.0F, std::cos(angle));
      rings.push_back({{0, 0, z + radius * std::sin(angle)}, wide, wide});
    }
  };
  const auto quarter = static_cast<float>(M_PI_2);
  cap(-length, radius_bottom, -quarter, 0);
  for (int i = 1; i < 6; ++i) {
    const float t = static_cast<float>(i) / 6;
    const float straight = radius_bottom + t * (radius_top - radius_bottom);
    const float bulge = 4 * t * (1 - t) * (radius_middle - 0.5F * (radius_top + radius_bottom));
    rings.push_back({{0, 0, -length * (1 - t)}, straight + bulge, straight + bulge});
  }
  cap(0, radius_top, 0, quarter);
  return rings;
}

}  // namespace stillpoint::simulation
