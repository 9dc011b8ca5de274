#include "ros2_messages/cost_map_file.hpp"

#include <yaml-cpp/yaml.h>

#include <array>
#include <cstdint>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::ros2_messages {
namespace {

constexpr std::uintmax_t kLargestDescription = 1 << 20;       // bytes
constexpr std::uint8_t kOccupiedPixel = 0, kFreePixel = 254;  // anything else: unknown

/// From the image, whose first row has the largest y.
cv::Mat cells_of(const cv::Mat& image) {
  cv::Mat upright;
  cv::flip(image, upright, 0);
  cv::Mat cells(upright.size(), CV_8SC1, cv::Scalar(OccupancyGrid::kUnknown));
  cells.setTo(OccupancyGrid::kOccupied, upright == kOccupiedPixel);
  cells.setTo(OccupancyGrid::kFree, upright == kFreePixel);
  return cells;
}

/// Position x, y, z and quaternion x, y, z, w.
Pose pose_of(const std::array<double, 7>& numbers) {
  const auto [x, y, z, qx, qy, qz, qw] = numbers;
  Pose pose(Eigen::Quaterniond(qw, qx, qy, qz).normalized());
  pose.translation() = Eigen::Vector3d(x, y, z);
  return pose;
}

OccupancyGrid read(const std::filesystem::path& description) {
  const YAML::Node yaml = YAML::Load(read_input_file(description, kLargestDescription));
  OccupancyGrid grid;
  grid.resolution = yaml["resolution"].as<double>();
  const auto corner = yaml["origin"].as<std::array<double, 3>>();
  grid.header_from_origin = pose_of(yaml["world_from_map"].as<std::array<double, 7>>()) *
                            Eigen::Translation3d(corner[0], corner[1], 0);
  const auto image = description.parent_path() / yaml["image"].as<std::string>();
  grid.cells = cells_of(decode_image(read_image_file(image), cv::IMREAD_GRAYSCALE));
  return grid;
}

}  // namespace

std::optional<OccupancyGrid> read_cost_map(const std::filesystem::path& folder) {
  const std::filesystem::path description = folder / "map.yaml";
  if (folder.empty() || !std::filesystem::exists(description)) return std::nullopt;
  try {
    return read(description);
  } catch (const std::exception& error) {  // of YAML, and of OpenCV for an image that is none
    throw Error(Fault::kData, std::string("cannot read the cost map: ") + error.what(),
                description.string());
  }
}

}  // namespace stillpoint::ros2_messages
