#include "dense_map/map_picture.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <set>
#include <vector>

#include "semantic_octree/cost_map.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/image_codec.hpp"

namespace stillpoint::dense_map {
namespace {

using semantic_octree::ahead_on_floor;
using semantic_octree::floor_of;
using semantic_octree::for_each_occupied_voxel;
using semantic_octree::SemanticOctree;
using semantic_octree::SemanticVoxel;

constexpr int kOversampling = 2;       // drawn larger and scaled down
constexpr double kFieldOfView = 35.0;  // degrees, of the shorter side
constexpr double kNear = 0.05;         // metres
constexpr double kWide = 3;            // tangent of the direction beyond which nothing is drawn
constexpr int kShift = 4;              // fractional bits of pixels
const cv::Scalar kPaper(255, 255, 255), kInk(60, 52, 45);
constexpr std::array<std::uint8_t, 3> kBackground = {190, 190, 186};  // class 0; black hides shape

struct Face {
  Eigen::Vector3d centre;
  int axis = 0;      // of its normal
  double side = 1;   // +1 or -1: which way the normal goes
  cv::Scalar color;  // BGR
};

/// Where the world is and what is up in it.
struct Scene {
  std::vector<Face> faces;
  double edge = 0;  // metres, of a voxel
  Eigen::Vector3d up, ahead;
};

struct View {
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
  Eigen::Matrix3d view_from_world;  // x right, y down, z forward
  double focal = 0;                 // px
  cv::Size size;

  Eigen::Vector3d from_eye(const Eigen::Vector3d& point) const {
    return view_from_world * (point - eye);
  }
};

bool is_free(const SemanticOctree& tree, const octomap::OcTreeKey& key) {
  const SemanticVoxel* voxel = tree.search(key);
  return voxel && !tree.isNodeOccupied(voxel);
}

octomap::OcTreeKey neighbour(octomap::OcTreeKey key, int axis, int step) {
  key[axis] = static_cast<octomap::key_type>(key[axis] + step);
  return key;
}

bool has_free_space(const SemanticOctree& tree) {
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf)
    if (!tree.isNodeOccupied(*leaf)) return true;
  return false;
}

cv::Scalar color_of(const SemanticVoxel& voxel, const SavedOctree& map, PictureOptions::Mode mode) {
  std::array<std::uint8_t, 3> rgb = {voxel.getColor().r, voxel.getColor().g, voxel.getColor().b};
  if (mode == PictureOptions::Mode::kClass) {
    const std::uint8_t label = voxel.classes().best();
    rgb = label > 0 && label < map.classes.colors.size() ? map.classes.colors[label] : kBackground;
  }
  return {static_cast<double>(rgb[2]), static_cast<double>(rgb[1]), static_cast<double>(rgb[0])};
}

// Light from the sky that what stands around a face leaves: of the eight voxels around the one
// before it, how many are empty.
double sky_light(const SemanticOctree& tree, const octomap::OcTreeKey& before, int axis) {
  int empty = 0;
  for (int a = -1; a <= 1; ++a)
    for (int b = -1; b <= 1; ++b)
      if (a != 0 || b != 0)
        empty +=
            !tree.is_occupied(neighbour(neighbour(before, (axis + 1) % 3, a), (axis + 2) % 3, b));
  return 0.6 + 0.05 * empty;
}

Scene scene_of(const SavedOctree& map, const PictureOptions& options) {
  const SemanticOctree& tree = *map.tree;
  const auto floor = floor_of(tree, {.floor = options.floor});
  if (!floor && options.highest)
    throw Error(Fault::kUsage, "no floor was found in the map; --below is a height above it", {},
                "say where it is: --floor=X,Y,Z,HEIGHT");
  Scene scene{.faces = {},
              .edge = tree.getResolution(),
              .up = floor ? floor->up : Eigen::Vector3d(0, -1, 0),
              .ahead = {}};
  scene.ahead = ahead_on_floor(scene.up);
  // The sun stands high to the right, so that the sides of things differ.
  const Eigen::Vector3d sun =
      (scene.up + 0.45 * scene.ahead.cross(scene.up) - 0.25 * scene.ahead).normalized();

  const bool carved = has_free_space(tree);
  for_each_occupied_voxel(tree, [&](const Eigen::Vector3d& at, const SemanticVoxel& voxel) {
    if (options.highest && floor->up.dot(at) - floor->height > *options.highest) return;
    const octomap::OcTreeKey key = tree.coordToKey(at.x(), at.y(), at.z());
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-1, 1}) {
        const octomap::OcTreeKey before = neighbour(key, axis, side);
        if (carved ? !is_free(tree, before) : tree.is_occupied(before)) continue;
        const double light = sky_light(tree, before, axis) * (0.8 + 0.2 * side * sun[axis]);
        scene.faces.push_back({.centre = at + 0.5 * scene.edge * side * Eigen::Vector3d::Unit(axis),
                               .axis = axis,
                               .side = static_cast<double>(side),
                               .color = light * color_of(voxel, map, options.mode)});
      }
  });
  return scene;
}

// `ahead` is up in the picture of one who looks straight down.
Eigen::Matrix3d looking_along(const Eigen::Vector3d& forward, const Eigen::Vector3d& up,
                              const Eigen::Vector3d& ahead) {
  Eigen::Vector3d right = forward.cross(up);
  if (right.norm() < 1e-3) right = ahead.cross(up);
  right.normalize();
  Eigen::Matrix3d view_from_world;
  view_from_world.row(0) = right;
  view_from_world.row(1) = forward.cross(right);
  view_from_world.row(2) = forward;
  return view_from_world;
}

// As near as all faces are in the picture, in its middle.
void fit(View& view, const Scene& scene) {
  const double half_width = 0.5 * view.size.width / view.focal;
  const double half_height = 0.5 * view.size.height / view.focal;
  constexpr double kMargin = 1.04;
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::max());
  Eigen::Vector3d high = -low;
  for (const Face& face : scene.faces) {
    const Eigen::Vector3d at = view.view_from_world * face.centre;
    low = low.cwiseMin(at);
    high = high.cwiseMax(at);
  }
  // The pyramid around all points: its sides, then the place on which they meet.
  Eigen::Vector4d sides = Eigen::Vector4d::Constant(-std::numeric_limits<double>::max());
  for (const Face& face : scene.faces) {
    const Eigen::Vector3d at = view.view_from_world * face.centre - 0.5 * (low + high);
    sides = sides.cwiseMax(Eigen::Vector4d(
        kMargin * at.x() / half_width - at.z(), -kMargin * at.x() / half_width - at.z(),
        kMargin * at.y() / half_height - at.z(), -kMargin * at.y() / half_height - at.z()));
  }
  const Eigen::Vector3d shift(0.5 * half_width / kMargin * (sides[0] - sides[1]),
                              0.5 * half_height / kMargin * (sides[2] - sides[3]),
                              -std::max(0.5 * (sides[0] + sides[1]), 0.5 * (sides[2] + sides[3])));
  view.eye = view.view_from_world.transpose() * (0.5 * (low + high) + shift);
}

View view_of(const Scene& scene, const PictureOptions& options) {
  View view;
  view.size = options.size * kOversampling;
  view.focal =
      0.5 * std::min(view.size.width, view.size.height) / std::tan(0.5 * kFieldOfView * M_PI / 180);
  if (options.eye && options.target) {
    view.eye = *options.eye;
    const Eigen::Vector3d forward = *options.target - *options.eye;
    if (forward.norm() < 1e-9) throw Error(Fault::kUsage, "--eye and --look-at are the same point");
    view.view_from_world = looking_along(forward.normalized(), scene.up, scene.ahead);
    return view;
  }
  const double down = options.elevation * M_PI / 180, turn = options.azimuth * M_PI / 180;
  const Eigen::Vector3d along = Eigen::AngleAxisd(-turn, scene.up) * scene.ahead;
  view.view_from_world =
      looking_along(std::cos(down) * along - std::sin(down) * scene.up, scene.up, along);
  fit(view, scene);
  return view;
}

// Of cubes of one size, the nearer one hides the farther one: what is far is drawn first.
cv::Mat drawn(Scene& scene, const View& view) {
  std::erase_if(scene.faces, [&](const Face& face) {
    return face.side * (view.eye - face.centre)[face.axis] <= 0;
  });
  std::ranges::stable_sort(scene.faces, std::greater{}, [&](const Face& face) {
    return (face.centre - view.eye).squaredNorm();
  });
  cv::Mat picture(view.size, CV_8UC3, kPaper);
  for (const Face& face : scene.faces) {
    const Eigen::Vector3d a = 0.5 * scene.edge * Eigen::Vector3d::Unit((face.axis + 1) % 3);
    const Eigen::Vector3d b = 0.5 * scene.edge * Eigen::Vector3d::Unit((face.axis + 2) % 3);
    std::array<cv::Point, 4> corners;
    bool visible = true;
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d at =
          view.from_eye(face.centre + (i == 0 || i == 3 ? -a : a) + (i < 2 ? -b : b));
      visible = at.z() > kNear && at.head<2>().cwiseAbs().maxCoeff() < kWide * at.z();
      if (!visible) break;
      const auto pixel = [&](double place, int size) {
        return cvRound((view.focal * place / at.z() + 0.5 * size) * (1 << kShift));
      };
      corners[i] = {pixel(at.x(), view.size.width), pixel(at.y(), view.size.height)};
    }
    if (visible) cv::fillConvexPoly(picture, corners, face.color, cv::LINE_8, kShift);
  }
  return picture;
}

// Names of the classes that are in the map, below one another.
void add_legend(cv::Mat& picture, const SavedOctree& map) {
  std::set<std::uint8_t> labels;
  for_each_occupied_voxel(*map.tree, [&](const Eigen::Vector3d&, const SemanticVoxel& voxel) {
    labels.insert(voxel.classes().best());
  });
  const double scale = 0.55 * kOversampling;
  const int line = 24 * kOversampling, box = 14 * kOversampling;
  int y = line;
  for (const std::uint8_t label : labels) {
    if (label >= map.classes.names.size()) continue;
    const auto rgb = label > 0 ? map.classes.colors[label] : kBackground;
    cv::rectangle(picture, cv::Rect(line / 2, y - box / 2, box, box),
                  cv::Scalar(rgb[2], rgb[1], rgb[0]), cv::FILLED);
    cv::putText(picture, map.classes.names[label], {line / 2 + box + box / 2, y + box / 2 - 2},
                cv::FONT_HERSHEY_SIMPLEX, scale, kInk, kOversampling, cv::LINE_AA);
    y += line;
  }
}

}  // namespace

cv::Mat picture_of(const SavedOctree& map, const PictureOptions& options) {
  const bool classes = options.mode == PictureOptions::Mode::kClass;
  if (classes ? map.classes.names.empty() : !map.has_colors)
    throw Error(Fault::kUsage, classes ? "the map has no classes" : "the map has no colours", "",
                "draw the map.ot of a run: .bt files and plain octrees only say what is occupied");
  Scene scene = scene_of(map, options);
  if (scene.faces.empty()) throw Error(Fault::kUsage, "there is nothing to draw");
  const View view = view_of(scene, options);
  cv::Mat large = drawn(scene, view), picture;
  if (classes) add_legend(large, map);
  cv::resize(large, picture, options.size, 0, 0, cv::INTER_AREA);
  return picture;
}

void write_picture(const cv::Mat& picture, const std::filesystem::path& file) {
  const std::vector<std::uint8_t> bytes = encode_image(".png", picture);
  AtomicFile out(file);
  out.stream().write(reinterpret_cast<const char*>(bytes.data()),
                     static_cast<std::streamsize>(bytes.size()));
  out.commit();
}

}  // namespace stillpoint::dense_map
