#include "semantic_octree/cost_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "semantic_octree/map_files.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/atomic_file.hpp"

namespace stillpoint::semantic_octree {
namespace {

constexpr double kLow = 0.3;  // metres above `from`: free space there rules out low obstacles
constexpr double kMinObstacleArea = 0.02;  // m² of surface; less may be remains of a shoe or hand
constexpr float kConfirmed = 0.75F;  // log-odds; by default, takes hits of more than one key frame
constexpr double kMostCells = 1e8;
constexpr double kMinFreeShare = 0.5;  // of a column: free space below a table top is not enough

Pose floor_from_world(const FloorPlane& floor) {
  const Eigen::Vector3d ahead = ahead_on_floor(floor.up);
  Pose pose = Pose::Identity();
  pose.linear().row(0) = ahead;
  pose.linear().row(1) = floor.up.cross(ahead);
  pose.linear().row(2) = floor.up;
  pose.translation().z() = -floor.height;
  return pose;
}

// The floor's axes are not those of the voxels: of each voxel eight points, so that no cell is
// passed over.
template <typename Function>
void for_each_part(const Eigen::Vector3d& centre, double edge, double step, Function&& function) {
  const int parts = static_cast<int>(std::lround(edge / step));
  const double first = 0.5 * (step - edge);
  for (int x = 0; x < parts; ++x)
    for (int y = 0; y < parts; ++y)
      for (int z = 0; z < parts; ++z)
        function(Eigen::Vector3d(centre + Eigen::Vector3d::Constant(first) +
                                 step * Eigen::Vector3d(x, y, z)));
}

class Projection {
 public:
  Projection(const SemanticOctree& tree, const FloorPlane& floor, const CostMapOptions& options)
      : tree_(tree), options_(options), part_(0.5 * tree.getResolution()) {
    map_.resolution = tree.getResolution();
    // The floor's own voxels reach as high.
    options_.from = std::max(options_.from, map_.resolution);
    options_.to = std::max(options_.to, options_.from + map_.resolution);
    map_.floor_from_world = floor_from_world(floor);
  }

  CostMap run() {
    make_cells();
    for_each_leaf([&](const Eigen::Vector3d& centre, double edge, float log_odds) {
      for_each_part(centre, edge, part_, [&](const Eigen::Vector3d& part) {
        add(map_.floor_from_world * part, log_odds);
      });
    });
    classify_obstacles();
    decide();
    inflate_obstacles();
    return std::move(map_);
  }

 private:
  // What is above a cell.
  struct Column {
    int obstacle = 0;       // parts
    int sure = 0;           // of them
    int free = 0;           // parts
    bool low = false;       // the floor was seen, or rays passed just above it
    bool doubtful = false;  // an obstacle seen too little to be sure of
  };

  template <typename Function>
  void for_each_leaf(Function&& function) const {
    for (auto leaf = tree_.begin_leafs(); leaf != tree_.end_leafs(); ++leaf) {
      const Eigen::Vector3d centre(leaf.getX(), leaf.getY(), leaf.getZ());
      const double height = (map_.floor_from_world * centre).z();
      if (height + leaf.getSize() > -options_.from && height - leaf.getSize() < options_.to)
        function(centre, leaf.getSize(), leaf->getLogOdds());
    }
  }

  void make_cells() {
    Eigen::Vector2d low = Eigen::Vector2d::Constant(std::numeric_limits<double>::max());
    Eigen::Vector2d high = -low;
    for_each_leaf([&](const Eigen::Vector3d& centre, double edge, float) {
      const Eigen::Vector2d at = (map_.floor_from_world * centre).head<2>();
      const double reach = 0.5 * std::sqrt(3) * edge;
      low = low.cwiseMin(at - Eigen::Vector2d::Constant(reach));
      high = high.cwiseMax(at + Eigen::Vector2d::Constant(reach));
    });
    if (low.x() > high.x()) low = high = Eigen::Vector2d::Zero();
    const double margin = options_.robot_radius + map_.resolution;
    map_.corner = ((low.array() - margin) / map_.resolution).floor() * map_.resolution;
    const Eigen::Array2d extent =
        ((high.array() + margin - map_.corner.array()) / map_.resolution).ceil();
    if (!(extent.prod() <= kMostCells))
      throw Error(Fault::kData, "the map is too wide for a cost map", {}, "map with larger voxels");
    const Eigen::Array2i size = extent.cast<int>();
    map_.cells = cv::Mat(size.y(), size.x(), CV_8UC1, cv::Scalar(CostMap::kUnknown));
    columns_.resize(map_.cells.total());
  }

  void add(const Eigen::Vector3d& at, float log_odds) {
    const bool occupied = log_odds >= tree_.getOccupancyThresLog();
    const auto column = static_cast<int>((at.x() - map_.corner.x()) / map_.resolution);
    const auto row = static_cast<int>((at.y() - map_.corner.y()) / map_.resolution);
    Column& cell =
        columns_[static_cast<std::size_t>((map_.cells.rows - 1 - row) * map_.cells.cols + column)];
    const bool inside = at.z() >= options_.from && at.z() < options_.to;
    cell.obstacle += occupied && inside;
    cell.sure += occupied && inside && log_odds > kConfirmed;
    cell.low |=
        occupied ? std::abs(at.z()) < options_.from : inside && at.z() < options_.from + kLow;
    cell.free += !occupied && inside;
    carved_ |= !occupied;
  }

  // For each connected group of obstacles: one that is too small is ignored, and one that was seen
  // only once stays unknown, since an undetected person may have stood there.
  void classify_obstacles() {
    cv::Mat obstacles(map_.cells.size(), CV_8UC1), labels;
    for (std::size_t i = 0; i < columns_.size(); ++i) obstacles.data[i] = columns_[i].obstacle > 0;
    const int count = cv::connectedComponents(obstacles, labels, 8, CV_32S);
    const auto* label = labels.ptr<int>();
    std::vector<int> parts(static_cast<std::size_t>(count)), sure(parts);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      parts[label[i]] += columns_[i].obstacle;
      sure[label[i]] += columns_[i].sure;
    }
    const double least = 8 * kMinObstacleArea / (map_.resolution * map_.resolution);
    for (std::size_t i = 0; i < columns_.size(); ++i) {
      Column& column = columns_[i];
      column.doubtful = column.obstacle > 0 && parts[label[i]] >= least;
      if (sure[label[i]] < least) column.obstacle = 0;
    }
  }

  void decide() {
    const double parts_per_column = (options_.to - options_.from) / part_ *
                                    (map_.resolution / part_) * (map_.resolution / part_);
    std::uint8_t* cell = map_.cells.data;
    for (const Column& column : columns_) {
      if (column.obstacle > 0)
        *cell = CostMap::kOccupied;
      else if (!column.doubtful && column.low &&
               (!carved_ || column.free > kMinFreeShare * parts_per_column))
        *cell = CostMap::kFree;
      ++cell;
    }
  }

  void inflate_obstacles() {
    if (options_.robot_radius <= 0) return;
    const cv::Mat elsewhere = map_.cells != CostMap::kOccupied;
    cv::Mat distance;  // in cells, to the next obstacle
    cv::distanceTransform(elsewhere, distance, cv::DIST_L2, cv::DIST_MASK_PRECISE);
    map_.cells.setTo(CostMap::kOccupied, distance <= options_.robot_radius / map_.resolution);
  }

  const SemanticOctree& tree_;
  CostMapOptions options_;
  double part_;  // metres
  CostMap map_;
  std::vector<Column> columns_;  // of the cells, in their order
  bool carved_ = false;          // whether the map knows free space at all
};

}  // namespace

bool CostMapOptions::is_floor(const std::vector<double>& numbers) {
  if (numbers.empty()) return true;
  if (numbers.size() != 3 && numbers.size() != 4) return false;
  const double length = std::hypot(numbers[0], numbers[1], numbers[2]);
  return length > 1e-6 && length < 1e6 && std::abs(numbers.back()) < 1e6;
}

void CostMapOptions::visit(OptionVisitor& v) {
  v("from", from,
    {.min = 0,
     .max = 10,
     .unit = "m",
     .help = "height above the floor; what is lower is no obstacle"});
  v("to", to,
    {.min = 0,
     .max = 10,
     .unit = "m",
     .help = "height above the floor; what is higher is no obstacle"});
  v("robot_radius", robot_radius,
    {.min = 0, .max = 10, .unit = "m", .help = "obstacles are inflated by this radius"});
  v("floor", floor,
    {.help = "upward direction x, y, z in the world, and the floor's height along it in m; without "
             "the height, or without all, it is found in the map"});
  v.require(from < to, "from must be lower than to");
  v.require(is_floor(floor), "floor takes x, y, z of a direction, then its height or nothing");
}

cv::Point CostMap::cell_of(const Eigen::Vector3d& point_in_world) const {
  const Eigen::Vector3d at = floor_from_world * point_in_world;
  return {static_cast<int>(std::floor((at.x() - corner.x()) / resolution)),
          cells.rows - 1 - static_cast<int>(std::floor((at.y() - corner.y()) / resolution))};
}

std::optional<FloorPlane> floor_of(const SemanticOctree& tree, const CostMapOptions& options) {
  const std::vector<double>& given = options.floor;
  const Eigen::Vector3d up =
      given.empty() ? Eigen::Vector3d(0, -1, 0) : Eigen::Vector3d(given[0], given[1], given[2]);
  if (given.size() == 4) return FloorPlane{.up = up.normalized(), .height = given[3]};
  std::vector<Eigen::Vector3f> points;
  for_each_occupied_voxel(tree, [&](const Eigen::Vector3d& at, const SemanticVoxel&) {
    points.push_back(at.cast<float>());
  });
  return given.empty() ? find_floor(points, up, tree.getResolution())
                       : find_floor_below(points, up.normalized(), tree.getResolution());
}

CostMap project(const SemanticOctree& tree, const FloorPlane& floor,
                const CostMapOptions& options) {
  return Projection(tree, floor, options).run();
}

void write_cost_map(const CostMap& map, const std::filesystem::path& stem) {
  const auto with = [&](const char* extension) {
    return std::filesystem::path(stem.string() + extension);
  };
  AtomicFile image(with(".pgm")), description(with(".yaml"));
  image.stream() << "P5\n" << map.cells.cols << ' ' << map.cells.rows << "\n255\n";
  image.stream().write(reinterpret_cast<const char*>(map.cells.data),
                       static_cast<std::streamsize>(map.cells.total()));
  const Pose world_from_map = map.floor_from_world.inverse();
  const Eigen::Vector3d t = world_from_map.translation();
  const Eigen::Quaterniond q(world_from_map.linear());
  description.stream() << "image: " << with(".pgm").filename()  // in quotation marks
                       << "\nmode: trinary\nresolution: " << map.resolution << "\norigin: ["
                       << map.corner.x() << ", " << map.corner.y() << ", 0]\n"
                       << "negate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
                       << "world_from_map: [" << t.x() << ", " << t.y() << ", " << t.z() << ", "
                       << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w() << "]\n";
  image.flush();
  description.flush();
  image.commit();
  description.commit();
}

}  // namespace stillpoint::semantic_octree
