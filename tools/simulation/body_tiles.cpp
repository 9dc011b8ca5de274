#include "simulation/body_tiles.hpp"

#include <algorithm>
#include <cmath>

namespace stillpoint::simulation {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3f;

constexpr float kNear = 0.05F;  // metres; what is nearer may be anywhere in the image
constexpr float kMargin = 3;    // px, for views beside the centres of pixels and uneven motion

}  // namespace

BodyTiles::BodyTiles(const Camera& camera, int tile_width, int tile_height)
    : camera_(camera),
      tile_width_(tile_width),
      tile_height_(tile_height),
      columns_((camera.width + tile_width - 1) / tile_width),
      rows_((camera.height + tile_height - 1) / tile_height),
      tiles_(static_cast<std::size_t>(columns_ * rows_)) {}

void BodyTiles::add(const Eigen::AlignedBox3f& box,
                    std::span<const Eigen::Affine3f> world_from_body, std::span<const Eye> eyes) {
  Eigen::AlignedBox2f seen;
  bool before = false;
  bool behind = false;
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vector3f in_body = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(corner));
      const Vector3f p = eyes[i].in_camera(world_from_body[i] * in_body);
      (p.z() < kNear ? behind : before) = true;
      seen.extend(Vector2f(static_cast<float>(camera_.fx) * p.x() / p.z(),
                           static_cast<float>(camera_.fy) * p.y() / p.z()));
    }
  }
  if (!before) return;
  if (behind) {
    std::fill(tiles_.begin(), tiles_.end(), 1);
    return;
  }
  const Vector2f centre(static_cast<float>(camera_.cx), static_cast<float>(camera_.cy));
  mark({seen.min() + centre - Vector2f::Constant(kMargin),
        seen.max() + centre + Vector2f::Constant(kMargin)});
}

void BodyTiles::mark(const Eigen::AlignedBox2f& pixels) {
  const auto tile = [](float pixel, int size, int count) {
    return static_cast<int>(
        std::clamp(std::floor(pixel / static_cast<float>(size)), -1.0F, static_cast<float>(count)));
  };
  const int first = std::max(tile(pixels.min().x(), tile_width_, columns_), 0);
  const int last = std::min(tile(pixels.max().x(), tile_width_, columns_), columns_ - 1);
  const int top = std::max(tile(pixels.min().y(), tile_height_, rows_), 0);
  const int bottom = std::min(tile(pixels.max().y(), tile_height_, rows_), rows_ - 1);
  for (int row = top; row <= bottom; ++row)
    for (int column = first; column <= last; ++column)
      tiles_[static_cast<std::size_t>(row * columns_ + column)] = 1;
}

}  // namespace stillpoint::simulation
