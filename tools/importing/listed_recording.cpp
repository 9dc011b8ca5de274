#include "importing/listed_recording.hpp"

#include <array>
#include <utility>

#include "importing/images.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::importing {

ListedRecording::ListedRecording(Lists lists, const CameraModel& camera, std::size_t most_frames)
    : color_(sorted_by_time(std::move(lists.color))),
      depth_(sorted_by_time(std::move(lists.depth))) {
  camera_ = camera;
  truth_ = sorted_by_time(std::move(lists.truth));
  notes_ = std::move(lists.notes);
  if (color_.size() > most_frames) color_.resize(most_frames);
  if (depth_.size() > most_frames) depth_.resize(most_frames);
  check_first_pair(color_.front().file, depth_.front().file, camera_);
}

std::size_t ListedRecording::size() const { return std::max(color_.size(), depth_.size()); }

ForeignFrame ListedRecording::read(std::size_t index) {
  ForeignFrame frame;
  if (index < color_.size()) frame.color = kept_image(color_[index].time, color_[index].file);
  if (index < depth_.size()) frame.depth = kept_image(depth_[index].time, depth_[index].file);
  return frame;
}

StampedPose tum_pose_of(const tum_recording::ListLine& line, const std::filesystem::path& file) {
  const std::string where = file.string() + ":" + std::to_string(line.number);
  std::array<double, 8> values{};
  for (std::size_t i = 0; i < values.size(); ++i) {
    const auto value =
        i < line.columns.size() ? tum_recording::parse_number(line.columns[i]) : std::nullopt;
    if (!value)
      throw Error(Fault::kData, "is no pose", where, "expected time tx ty tz qx qy qz qw");
    values[i] = *value;
  }
  const Eigen::Quaterniond rotation(values[7], values[4], values[5], values[6]);
  if (rotation.norm() < 0.5) throw Error(Fault::kData, "the quaternion is zero", where);
  StampedPose pose{.time = values[0]};
  pose.world_from_camera.linear() = rotation.normalized().toRotationMatrix();
  pose.world_from_camera.translation() = Eigen::Vector3d(values[1], values[2], values[3]);
  return pose;
}

}  // namespace stillpoint::importing
