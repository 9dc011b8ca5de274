#include "importing/seven_scenes.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "depth_registration/depth_registration.hpp"
#include "importing/images.hpp"
#include "importing/matrix_pose.hpp"
#include "stillpoint/error.hpp"
#include "tum_recording/image_reader.hpp"

namespace stillpoint::importing {
namespace {

using depth_registration::DepthRegistration;

constexpr std::string_view kFramePrefix = "frame-";
constexpr double kSevenScenesRate = 30;    // Hz; the data set has numbers instead of times
constexpr std::uint16_t kNoDepth = 65535;  // in its depth images

/// Of the depth camera, as the data set's page gives it.
Camera seven_scenes_depth_camera() {
  return {.width = 640, .height = 480, .fx = 585, .fy = 585, .cx = 320, .cy = 240};
}

/// "frame-000042" of "frame-000042.color.png".
std::optional<std::string> frame_of_color(const std::string& name) {
  const std::size_t end = name.find(".color.");
  if (!name.starts_with(kFramePrefix) || end == std::string::npos) return std::nullopt;
  return name.substr(0, end);
}

class SevenScenes final : public ForeignRecording {
 public:
  SevenScenes(const std::filesystem::path& folder, const ImportOptions& options) : folder_(folder) {
    camera_ = options.camera.value();
    for (const std::string& name : file_names(folder))
      if (frame_of_color(name) && colors_.size() < options.most_frames) colors_.push_back(name);
    if (colors_.empty())
      throw Error(Fault::kData, "has no images frame-000000.color.png", folder.string(),
                  "give the folder of one sequence, such as chess/seq-01");
    if (!options.camera_is_users) {
      registration_.emplace(seven_scenes_depth_camera(), camera_.undistorted(), Pose::Identity());
      notes_.emplace_back(
          "depth was moved from the depth camera (focal length 585) to the colour camera (525); "
          "the 2.5 cm between them are not published and stay uncorrected; if your depth images "
          "are registered, name their camera with --camera");
    }
    const std::filesystem::path first = folder / colors_.front();
    check_size(reader_.color(first).size(), camera_, first.string());
    read_poses();
  }

  std::size_t size() const override { return colors_.size(); }

  ForeignFrame read(std::size_t index) override {
    const std::filesystem::path depth_file = beside(index, ".depth.png");
    cv::Mat depth = reader_.depth(depth_file);
    depth.setTo(0, depth == kNoDepth);
    check_size(depth.size(), camera_, depth_file.string());
    if (registration_) depth = registration_->register_image(depth, camera_.depth_factor);
    return {kept_image(time(index), folder_ / colors_[index]), new_depth(time(index), depth)};
  }

 private:
  double time(std::size_t index) const {
    const auto number = number_of(frame_of_color(colors_[index])->substr(kFramePrefix.size()));
    if (!number)
      throw Error(Fault::kData, "has no number in its name", (folder_ / colors_[index]).string());
    return static_cast<double>(*number) / kSevenScenesRate;
  }

  std::filesystem::path beside(std::size_t index, const char* ending) const {
    return folder_ / (*frame_of_color(colors_[index]) + ending);
  }

  void read_poses() {
    std::size_t missing = 0;
    for (std::size_t i = 0; i < size(); ++i) {
      const std::filesystem::path file = beside(i, ".pose.txt");
      const auto pose = std::filesystem::exists(file) ? read_matrix_pose(file) : std::nullopt;
      if (pose)
        truth_.push_back({time(i), *pose});
      else
        ++missing;
    }
    if (missing > 0)
      notes_.push_back(std::to_string(missing) + " of " + std::to_string(size()) +
                       " images have no true pose");
  }

  std::filesystem::path folder_;
  std::vector<std::string> colors_;
  std::optional<DepthRegistration> registration_;
  tum_recording::ImageReader reader_;
};

}  // namespace

bool is_seven_scenes(const std::filesystem::path& recording) {
  return std::ranges::any_of(file_names(recording), [](const std::string& name) {
    return frame_of_color(name).has_value();
  });
}

std::unique_ptr<ForeignRecording> open_seven_scenes(const std::filesystem::path& recording,
                                                    const ImportOptions& options) {
  return std::make_unique<SevenScenes>(recording, options);
}

}  // namespace stillpoint::importing
