#include "height_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stillpoint/support/atomic_file.hpp>
#include <utility>

namespace {

using stillpoint::AtomicFile;

constexpr float kThickness = 0.05F;  // metres, of a surface with the noise of depth
constexpr double kLargest = 65535;   // of a pixel with 16 bits
constexpr int kPictureSide = 600;    // px, at least

/// To the frame of a HeightGrid. The world is the first camera's frame: z ahead.
Eigen::Isometry3f map_from_world(const Floor& floor) {
  Eigen::Vector3f ahead = Eigen::Vector3f::UnitZ();
  if (std::abs(ahead.dot(floor.up)) > 0.95F) ahead = -Eigen::Vector3f::UnitY();  // it looks down
  const Eigen::Vector3f left = floor.up.cross(ahead).normalized();
  Eigen::Isometry3f pose = Eigen::Isometry3f::Identity();
  pose.linear() << left.cross(floor.up).transpose(), left.transpose(), floor.up.transpose();
  pose.translation().z() = -floor.height;
  return pose;
}

/// Unknown cells, as many as points in the map's frame extend over.
void make_cells(HeightGrid& grid, const std::vector<Eigen::Vector3f>& points) {
  Eigen::Array2f low = Eigen::Array2f::Constant(std::numeric_limits<float>::max()), high = -low;
  for (const Eigen::Vector3f& point : points) {
    low = low.min(point.head<2>().array());
    high = high.max(point.head<2>().array());
  }
  const auto resolution = static_cast<float>(grid.resolution);
  const Eigen::Array2f first = (low / resolution).floor(), last = (high / resolution).floor();
  const Eigen::Array2i size = (last - first + 1).cast<int>();
  grid.corner = first * resolution;
  grid.heights = cv::Mat::zeros(size.y(), size.x(), CV_32FC1);
  grid.known = cv::Mat::zeros(size.y(), size.x(), CV_8UC1);
}

/// The mean height of the points at the highest place that `min_points` reach.
std::optional<float> surface_of(std::vector<float>& heights, int min_points) {
  if (heights.size() < static_cast<std::size_t>(min_points)) return std::nullopt;
  std::ranges::sort(heights);
  const auto end = heights.end() - min_points + 1;
  const auto begin = std::lower_bound(heights.begin(), end, *(end - 1) - kThickness);
  return std::accumulate(begin, end, 0.0F) / static_cast<float>(end - begin);
}

/// 0 unknown, else 1 … 65535 from the lowest height to the highest.
cv::Mat with_16_bits(const HeightGrid& grid, double lowest, double highest) {
  cv::Mat values;
  cv::Mat(grid.heights - lowest).convertTo(values, CV_16U, kLargest / (highest - lowest));
  cv::max(values, 1, values);
  values.setTo(0, ~grid.known);
  return values;
}

/// Heights from the floor up as colours from blue to red; grey is unknown.
cv::Mat picture_of(const HeightGrid& grid, double highest) {
  cv::Mat values, picture;
  grid.heights.convertTo(values, CV_8U, 255 / highest);
  cv::applyColorMap(values, picture, cv::COLORMAP_TURBO);
  picture.setTo(cv::Scalar::all(40), ~grid.known);
  const int scale = kPictureSide / std::max(picture.rows, picture.cols) + 1;
  cv::resize(picture, picture, {}, scale, scale, cv::INTER_NEAREST);
  return picture;
}

void write_png(const cv::Mat& image, std::ostream& stream) {
  std::vector<unsigned char> bytes;
  cv::imencode(".png", image, bytes);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
}

/// With the keys of ROS's map_server, and those of grid_map for heights.
void write_description(const HeightGrid& grid, const GridOptions& options, std::ostream& stream) {
  const Eigen::Isometry3f world_from_map = grid.map_from_world.inverse();
  const Eigen::Vector3f t = world_from_map.translation();
  const Eigen::Quaternionf q(world_from_map.linear());
  stream << "image: height_map.png  # 16 bits; 0 is unknown\n"
         << "resolution: " << grid.resolution << "  # metres per cell\n"
         << "origin: [" << grid.corner.x() << ", " << grid.corner.y()
         << ", 0]  # of the lower left corner: x, y in metres, yaw\n"
         << "min_height: " << options.min_height
         << "  # height = min_height + value / 65535 * (max_height - min_height)\n"
         << "max_height: " << options.max_height << "  # metres above the floor\n"
         << "camera_height: " << grid.map_from_world.translation().z()
         << "  # metres, of the first camera above the floor\n"
         << "world_from_map: [" << t.x() << ", " << t.y() << ", " << t.z() << ", " << q.x() << ", "
         << q.y() << ", " << q.z() << ", " << q.w() << "]  # position, quaternion x, y, z, w\n";
}

}  // namespace

void GridOptions::visit(stillpoint::OptionVisitor& v) {
  v("resolution", resolution, {.min = 0.005, .max = 1, .unit = "m", .help = "side of a cell"});
  v("min_height", min_height,
    {.min = -10, .max = 0, .unit = "m", .help = "above the floor; what is lower is left out"});
  v("max_height", max_height,
    {.min = 0.1,
     .max = 10,
     .unit = "m",
     .help = "above the floor; what is higher is left out: robots drive under it"});
  v("min_points", min_points,
    {.min = 1, .max = 1000, .help = "that are as high as a cell: fewer are outliers"});
}

cv::Point HeightGrid::cell_of(const Eigen::Vector3f& point_in_map) const {
  const Eigen::Vector2f cell = (point_in_map.head<2>() - corner) / static_cast<float>(resolution);
  return {cvFloor(cell.x()), heights.rows - 1 - cvFloor(cell.y())};
}

HeightGrid make_grid(const std::vector<Eigen::Vector3f>& points_in_world, const Floor& floor,
                     const GridOptions& options) {
  HeightGrid grid{.resolution = options.resolution, .map_from_world = map_from_world(floor)};
  std::vector<Eigen::Vector3f> points;  // in the map
  for (const Eigen::Vector3f& point_in_world : points_in_world) {
    const Eigen::Vector3f point = grid.map_from_world * point_in_world;
    if (point.z() >= options.min_height && point.z() <= options.max_height) points.push_back(point);
  }
  make_cells(grid, points);
  std::map<std::pair<int, int>, std::vector<float>> heights;  // of the points by row and column
  for (const Eigen::Vector3f& point : points) {
    const cv::Point cell = grid.cell_of(point);
    heights[{cell.y, cell.x}].push_back(point.z());
  }
  for (auto& [cell, of_points] : heights)
    if (const auto height = surface_of(of_points, options.min_points)) {
      grid.heights.at<float>(cell.first, cell.second) = *height;
      grid.known.at<std::uint8_t>(cell.first, cell.second) = 255;
    }
  return grid;
}

void save(const HeightGrid& grid, const GridOptions& options,
          const std::filesystem::path& directory) {
  AtomicFile image(directory / "height_map.png"), description(directory / "height_map.yaml");
  AtomicFile picture(directory / "height_map_view.png");
  write_png(with_16_bits(grid, options.min_height, options.max_height), image.stream());
  write_png(picture_of(grid, options.max_height), picture.stream());
  write_description(grid, options, description.stream());
  for (AtomicFile* file : {&image, &description, &picture}) file->flush();
  for (AtomicFile* file : {&image, &description, &picture}) file->commit();
}
