#include "importing/euroc.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <array>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "importing/images.hpp"
#include "importing/listed_recording.hpp"
#include "importing/matrix_pose.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::importing {
namespace {

using tum_recording::ListLine;
using tum_recording::StampedImage;

constexpr double kNanosecond = 1e-9;                     // s
constexpr double kMillimetres = 1000;                    // depth value of one metre
constexpr std::uintmax_t kLargestDescription = 1 << 20;  // bytes

std::filesystem::path mav0_of(const std::filesystem::path& recording) {
  return std::filesystem::is_directory(recording / "mav0") ? recording / "mav0" : recording;
}

/// Empty when there is none.
std::filesystem::path color_folder_of(const std::filesystem::path& mav0) {
  for (const char* name : {"cam0", "rgb0"})
    if (std::filesystem::exists(mav0 / name / "data.csv")) return mav0 / name;
  return {};
}

[[noreturn]] void fail_at(const std::filesystem::path& file, int line, const std::string& problem) {
  throw Error(Fault::kData, problem, file.string() + ":" + std::to_string(line));
}

double nanoseconds_of(const ListLine& line, const std::filesystem::path& file) {
  const auto stamp = number_of(line.columns[0]);
  if (!stamp || line.columns[0].find('.') != std::string::npos)
    fail_at(file, line.number, "'" + line.columns[0] + "' is no time in nanoseconds");
  return kNanosecond * static_cast<double>(*stamp);
}

/// By data.csv, or by the names of the images where there is none.
std::vector<StampedImage> images_in(const std::filesystem::path& folder) {
  std::vector<StampedImage> images;
  const std::filesystem::path list = folder / "data.csv";
  if (std::filesystem::exists(list)) {
    for (const ListLine& line : tum_recording::read_list_lines(list)) {
      if (line.columns.size() < 2) fail_at(list, line.number, "names no image");
      images.push_back({nanoseconds_of(line, list), folder / "data" / line.columns[1]});
    }
  } else {
    for (const std::string& name : file_names(folder / "data"))
      if (const auto stamp = number_of(name))
        images.push_back({kNanosecond * static_cast<double>(*stamp), folder / "data" / name});
  }
  if (images.empty()) throw Error(Fault::kData, "has no images", folder.string());
  return images;
}

/// sensor.yaml; OpenCV's begin with a line that is no YAML.
YAML::Node sensor_of(const std::filesystem::path& folder) {
  const std::filesystem::path file = folder / "sensor.yaml";
  if (!std::filesystem::exists(file))
    throw Error(Fault::kData, "there is no calibration of the camera", file.string(),
                "name one with --camera");
  std::istringstream stream(read_input_file(file, kLargestDescription));
  std::ostringstream text;
  for (std::string line; std::getline(stream, line);)
    if (!line.starts_with("%YAML")) text << line << '\n';
  try {
    return YAML::Load(text.str());
  } catch (const YAML::Exception& error) {
    throw Error(Fault::kData, std::string("cannot be understood: ") + error.what(), file.string());
  }
}

CameraModel camera_of(const std::filesystem::path& folder) {
  const YAML::Node sensor = sensor_of(folder);
  const std::string where = (folder / "sensor.yaml").string();
  CameraModel camera;
  try {
    const auto size = sensor["resolution"].as<std::array<int, 2>>();
    const auto intrinsics = sensor["intrinsics"].as<std::array<double, 4>>();
    camera.name = folder.filename().string();
    camera.width = size[0];
    camera.height = size[1];
    camera.fx = intrinsics[0];
    camera.fy = intrinsics[1];
    camera.cx = intrinsics[2];
    camera.cy = intrinsics[3];
    if (sensor["distortion_coefficients"])
      camera.distortion = sensor["distortion_coefficients"].as<std::vector<double>>();
  } catch (const YAML::Exception& error) {
    throw Error(Fault::kData,
                std::string("resolution and intrinsics cannot be read: ") + error.what(), where,
                "name a camera with --camera");
  }
  const auto model = sensor["distortion_model"].as<std::string>("radial-tangential");
  const bool undistorted = std::ranges::all_of(camera.distortion, [](double k) { return k == 0; });
  if (undistorted) camera.distortion.clear();
  if (!undistorted && model != "radial-tangential" && model != "radtan" && model != "plumb_bob")
    throw Error(Fault::kData, "distortion model '" + model + "' is not supported", where,
                "rectify the images, and name their camera with --camera");
  camera.depth_factor = kMillimetres;
  return camera;
}

/// T_BS of a sensor.yaml; without one, the body is the sensor.
Pose body_from_sensor(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "sensor.yaml")) return Pose::Identity();
  const YAML::Node transform = sensor_of(folder)["T_BS"];
  if (!transform) return Pose::Identity();
  std::optional<Pose> pose;
  try {
    const auto values = transform["data"].as<std::array<double, 16>>();
    pose = pose_of(Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(values.data()));
  } catch (const YAML::Exception&) {
    pose.reset();
  }
  if (!pose)
    throw Error(Fault::kData, "T_BS is no rigid motion", (folder / "sensor.yaml").string());
  return *pose;
}

/// time, position, quaternion with w first: the pose of a sensor on the body, in the world.
std::vector<StampedPose> euroc_truth(const std::filesystem::path& mav0,
                                     const std::filesystem::path& color) {
  const std::filesystem::path folder = mav0 / "state_groundtruth_estimate0";
  const std::filesystem::path file = folder / "data.csv";
  if (!std::filesystem::exists(file)) return {};
  const Pose truth_from_camera = body_from_sensor(folder).inverse() * body_from_sensor(color);
  std::vector<StampedPose> poses;
  for (ListLine line : tum_recording::read_list_lines(file)) {
    const double time = nanoseconds_of(line, file);
    if (line.columns.size() < 8) fail_at(file, line.number, "is no pose");
    std::rotate(line.columns.begin() + 4, line.columns.begin() + 5, line.columns.begin() + 8);
    StampedPose pose = tum_pose_of(line, file);
    pose.time = time;
    pose.world_from_camera = pose.world_from_camera * truth_from_camera;
    poses.push_back(pose);
  }
  return poses;
}

}  // namespace

bool is_euroc(const std::filesystem::path& recording) {
  return !color_folder_of(mav0_of(recording)).empty();
}

std::unique_ptr<ForeignRecording> open_euroc(const std::filesystem::path& recording,
                                             const ImportOptions& options) {
  const std::filesystem::path mav0 = mav0_of(recording);
  const std::filesystem::path color = color_folder_of(mav0);
  if (color.empty())
    throw Error(Fault::kData, "has neither cam0/data.csv nor rgb0/data.csv", mav0.string());
  if (!std::filesystem::is_directory(mav0 / "depth0"))
    throw Error(Fault::kData, "has no depth images (depth0)", mav0.string(),
                std::filesystem::exists(mav0 / "cam1")
                    ? "this is a stereo recording; compute depth images in cam0 from it first"
                    : "a camera with depth is needed");
  ListedRecording::Lists lists{.color = images_in(color), .depth = images_in(mav0 / "depth0")};
  lists.truth = euroc_truth(mav0, color);
  if (!options.camera_is_users)
    lists.notes.emplace_back("depth was taken for millimetres; else name a camera with --camera");
  return std::make_unique<ListedRecording>(
      std::move(lists), options.camera ? *options.camera : camera_of(color), options.most_frames);
}

}  // namespace stillpoint::importing
