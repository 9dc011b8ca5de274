#include "simulation/body_tiles.hpp"

#include <algorithm>
#include <opencv2/imgproc.hpp>

namespace stillpoint::simulation {
namespace {

using Eigen::Vector3f;

constexpr float kNear = 0.05F;  // metres; what is nearer may be anywhere in the image

}  // namespace

BodyTiles::BodyTiles(const Camera& camera, int tile_width, int tile_height)
    : camera_(camera),
      tile_(tile_width, tile_height),
      tiles_((camera.height + tile_height - 1) / tile_height,
             (camera.width + tile_width - 1) / tile_width, CV_8UC1, cv::Scalar(0)) {}

void BodyTiles::add(const Eigen::AlignedBox3f& box,
                    std::span<const Eigen::Affine3f> world_from_body, std::span<const Eye> eyes) {
  std::vector<cv::Point2f> corners;
  bool behind = false;
  for (std::size_t i = 0; i < eyes.size(); ++i) {
    for (int k = 0; k < 8; ++k) {
      const Vector3f in_body = box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(k));
      const Vector3f p = eyes[i].in_camera(world_from_body[i] * in_body);
      if (p.z() < kNear)
        behind = true;
      else
        corners.push_back(tile_of(p));
    }
  }
  if (corners.empty()) return;
  if (behind)
    tiles_.setTo(1);
  else
    mark(corners);
}

/// Position of a point among the tiles; integers are their centres.
cv::Point2f BodyTiles::tile_of(const Vector3f& p) const {
  const double x = camera_.fx * p.x() / p.z() + camera_.cx;
  const double y = camera_.fy * p.y() / p.z() + camera_.cy;
  return {static_cast<float>((x + 0.5) / tile_.width - 0.5),
          static_cast<float>((y + 0.5) / tile_.height - 0.5)};
}

/// The tiles under the convex hull of `corners`, and a margin of a tile, for what rounding, views
/// beside the centres of pixels and uneven motion add.
void BodyTiles::mark(const std::vector<cv::Point2f>& corners) {
  constexpr float kMargin = 1;  // tiles
  constexpr float kFar = 1e4F;  // tiles; farther is as far, and integers hold it
  std::vector<cv::Point> grown;
  for (const cv::Point2f& corner : corners)
    for (const float dx : {-kMargin, kMargin})
      for (const float dy : {-kMargin, kMargin})
        grown.emplace_back(cvRound(std::clamp(corner.x + dx, -kFar, kFar)),
                           cvRound(std::clamp(corner.y + dy, -kFar, kFar)));
  std::vector<cv::Point> hull;
  cv::convexHull(grown, hull);
  cv::fillConvexPoly(tiles_, hull, cv::Scalar(1));
}

}  // namespace stillpoint::simulation
