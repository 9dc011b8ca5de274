#include "importing/icl_nuim_raw.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <limits>
#include <sstream>
#include <string>

#include "importing/icl_nuim.hpp"
#include "importing/images.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/input_file.hpp"

namespace stillpoint::importing {
namespace {

constexpr const char* kScenePrefix = "scene_";
constexpr const char* kSceneDepth = ".depth";

/// One distance per pixel, by rows, as text.
std::vector<double> distances_in(const std::filesystem::path& file) {
  const std::string text = read_input_file(file);
  std::vector<double> values;
  const char* end = text.data() + text.size();
  for (const char* at = text.data();;) {
    at = std::find_if(at, end, [](unsigned char c) { return std::isspace(c) == 0; });
    if (at == end) return values;
    double value = 0.0;
    const auto [rest, error] = std::from_chars(at, end, value);
    if (error != std::errc()) throw Error(Fault::kData, "is no text of numbers", file.string());
    values.push_back(value);
    at = rest;
  }
}

/// The vector of a line such as "cam_pos      = [149.376, 451.41, -285.9]';".
Eigen::Vector3d vector_in(const std::string& text, const std::string& key,
                          const std::filesystem::path& file) {
  std::size_t at = text.find(key);
  if (at != std::string::npos) at = text.find('[', at);
  Eigen::Vector3d vector = Eigen::Vector3d::Zero();
  char comma = 0;
  std::istringstream numbers(at == std::string::npos ? "" : text.substr(at + 1));
  if (!(numbers >> vector.x() >> comma >> vector.y() >> comma >> vector.z()))
    throw Error(Fault::kData, "has no vector " + key, file.string());
  return vector;
}

class IclNuimRaw final : public ForeignRecording {
 public:
  IclNuimRaw(const std::filesystem::path& folder, const ImportOptions& options) : folder_(folder) {
    camera_ = options.camera.value();
    for (const std::string& name : file_names(folder))
      if (name.starts_with(kScenePrefix) && name.ends_with(kSceneDepth) &&
          stems_.size() < options.most_frames)
        stems_.push_back(name.substr(0, name.size() - std::string(kSceneDepth).size()));
    if (stems_.empty()) throw Error(Fault::kData, "has no scene_….depth", folder.string());
    const bool living_room = std::ranges::count(stems_.front(), '_') == 2;
    units_per_metre_ = living_room ? 1 : 100;
    notes_.push_back(std::string("distances and positions were taken for ") +
                     (living_room ? "metres" : "centimetres") + ", by the names of the files");
    for (std::size_t i = 0; i < stems_.size(); ++i) truth_.push_back({time(i), pose(i)});
  }

  std::size_t size() const override { return stems_.size(); }

  ForeignFrame read(std::size_t index) override {
    return {kept_image(time(index), beside(index, ".png")), new_depth(time(index), depth(index))};
  }

 private:
  std::filesystem::path beside(std::size_t index, const char* ending) const {
    return folder_ / (stems_[index] + ending);
  }

  double time(std::size_t index) const {
    const std::string& stem = stems_[index];
    const auto number = number_of(stem.substr(stem.rfind('_') + 1));
    if (!number)
      throw Error(Fault::kData, "has no number in its name", beside(index, kSceneDepth).string());
    return static_cast<double>(*number) / kIclNuimRate;
  }

  /// The axes of the camera: along the view, up, and across both.
  Pose pose(std::size_t index) const {
    const std::filesystem::path file = beside(index, ".txt");
    const std::string text = read_input_file(file);
    const Eigen::Vector3d z = vector_in(text, "cam_dir", file).normalized();
    const Eigen::Vector3d x = vector_in(text, "cam_up", file).cross(z).normalized();
    Pose pose = Pose::Identity();
    pose.linear() << x, z.cross(x), z;
    pose.translation() = vector_in(text, "cam_pos", file) / units_per_metre_;
    if (!pose.matrix().allFinite() || x.isZero())
      throw Error(Fault::kData, "gives no orientation", file.string());
    return mirrored_in_y(pose);
  }

  cv::Mat depth(std::size_t index) const {
    const std::filesystem::path file = beside(index, kSceneDepth);
    const std::vector<double> distances = distances_in(file);
    if (distances.size() != static_cast<std::size_t>(camera_.width) * camera_.height)
      throw Error(Fault::kData,
                  "holds " + std::to_string(distances.size()) + " numbers, the camera '" +
                      camera_.name + "' has " + std::to_string(camera_.width) + " x " +
                      std::to_string(camera_.height) + " pixels",
                  file.string());
    const Camera camera = camera_.undistorted();
    cv::Mat image(camera_.height, camera_.width, CV_16UC1, cv::Scalar(0));
    for (int y = 0; y < image.rows; ++y)
      for (int x = 0; x < image.cols; ++x) {
        const double distance = distances[static_cast<std::size_t>(y) * image.cols + x];
        const double z = distance / units_per_metre_ / camera.unproject(x, y, 1.0).norm();
        const double value = std::round(z * camera_.depth_factor);
        if (value > 0 && value <= std::numeric_limits<std::uint16_t>::max())
          image.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(value);
      }
    return image;
  }

  std::filesystem::path folder_;
  std::vector<std::string> stems_;  // "scene_00_0000"
  double units_per_metre_ = 1;
};

}  // namespace

bool is_icl_nuim_raw(const std::filesystem::path& recording) {
  return std::ranges::any_of(file_names(recording), [](const std::string& name) {
    return name.starts_with(kScenePrefix) && name.ends_with(kSceneDepth);
  });
}

std::unique_ptr<ForeignRecording> open_icl_nuim_raw(const std::filesystem::path& recording,
                                                    const ImportOptions& options) {
  return std::make_unique<IclNuimRaw>(recording, options);
}

}  // namespace stillpoint::importing
