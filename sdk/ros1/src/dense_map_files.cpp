#include "dense_map_files.hpp"

#include <yaml-cpp/yaml.h>

#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stillpoint/error.hpp>
#include <vector>

#include "pose_messages.hpp"

namespace stillpoint_ros {
namespace {

using stillpoint::Error;
using stillpoint::Fault;
using stillpoint::Pose;

// As written by Stillpoint, and map_server.
constexpr int kOccupied = 0, kFree = 254;

Pose pose_of_numbers(const std::vector<double>& numbers) {
  Pose pose(Eigen::Quaterniond(numbers.at(6), numbers.at(3), numbers.at(4), numbers.at(5)));
  pose.translation() = Eigen::Vector3d(numbers.at(0), numbers.at(1), numbers.at(2));
  return pose;
}

// The first row of the image has the largest y, that of a grid the smallest.
std::vector<std::int8_t> cells_of(const cv::Mat& image) {
  std::vector<std::int8_t> cells;
  cells.reserve(image.total());
  for (int y = image.rows - 1; y >= 0; --y)
    for (int x = 0; x < image.cols; ++x) {
      const int value = image.at<std::uint8_t>(y, x);
      cells.push_back(value == kOccupied ? 100 : value == kFree ? 0 : -1);
    }
  return cells;
}

}  // namespace

octomap_msgs::Octomap octomap_message(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  octomap_msgs::Octomap message;
  message.binary = true;
  message.id = "OcTree";  // as which viewers take it, whatever else the tree could hold
  std::string line;
  while (std::getline(in, line) && line != "data") {
    if (line.rfind("res ", 0) == 0) message.resolution = std::strtod(line.c_str() + 4, nullptr);
  }
  message.data.assign(std::istreambuf_iterator<char>(in), {});
  if (!(message.resolution > 0) || message.data.empty())
    throw Error(Fault::kData, "is no .bt file of OctoMap", file.string());
  return message;
}

nav_msgs::OccupancyGrid grid_message(const std::filesystem::path& description,
                                     const Pose& map_from_world) try {
  const YAML::Node yaml = YAML::LoadFile(description.string());
  const auto image_file = description.parent_path() / yaml["image"].as<std::string>();
  const cv::Mat image = cv::imread(image_file.string(), cv::IMREAD_GRAYSCALE);
  if (image.empty()) throw Error(Fault::kData, "is no image", image_file.string());
  const auto corner = yaml["origin"].as<std::vector<double>>();  // x, y, angle
  const Pose world_from_floor = pose_of_numbers(yaml["world_from_map"].as<std::vector<double>>());
  nav_msgs::OccupancyGrid message;
  message.info.resolution = yaml["resolution"].as<float>();
  message.info.width = static_cast<std::uint32_t>(image.cols);
  message.info.height = static_cast<std::uint32_t>(image.rows);
  message.info.origin = pose_message(map_from_world * world_from_floor *
                                     Eigen::Translation3d(corner.at(0), corner.at(1), 0));
  message.data = cells_of(image);
  return message;
} catch (const YAML::Exception& error) {
  throw Error(Fault::kData, error.what(), description.string());
} catch (const std::out_of_range&) {
  throw Error(Fault::kData, "'origin' or 'world_from_map' has too few numbers",
              description.string());
}

}  // namespace stillpoint_ros
