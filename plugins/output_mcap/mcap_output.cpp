#include "output_mcap/mcap_output.hpp"

#include <opencv2/imgcodecs.hpp>
#include <utility>
#include <vector>

#include "mcap_writer/frames.hpp"
#include "output_mcap/cost_map_file.hpp"
#include "semantic_octree/octree_reader.hpp"
#include "stillpoint/support/trajectory.hpp"

namespace stillpoint::output_mcap {
namespace {

using mcap_writer::kCameraFrame;
using mcap_writer::kMapFrame;
using mcap_writer::map_from_world;

constexpr int kJpegQuality = 85;  // per cent

/// Of the camera in its own frame, from one pose to the next: m/s and rad/s.
Vector6d twist_between(const StampedPose& before, const StampedPose& after) {
  const double seconds = after.time - before.time;
  if (seconds <= 0) return Vector6d::Zero();
  return log_se3(before.world_from_camera.inverse() * after.world_from_camera) / seconds;
}

/// With the axes of the frame in which the camera's pose is given.
Matrix6d turned(const Matrix6d& covariance_in_camera, const Pose& target_from_camera) {
  Matrix6d rotation = Matrix6d::Zero();
  rotation.topLeftCorner<3, 3>() = target_from_camera.linear();
  rotation.bottomRightCorner<3, 3>() = target_from_camera.linear();
  return rotation * covariance_in_camera * rotation.transpose();
}

Eigen::Vector3f point_in_map(const Eigen::Vector3d& point_in_world) {
  return (map_from_world() * point_in_world).cast<float>();
}

std::uint32_t rgb_of(const LabelledPoint& point) {
  const auto [red, green, blue] = point.rgb;
  return static_cast<std::uint32_t>(red << 16 | green << 8 | blue);
}

}  // namespace

McapOutput::McapOutput(const Options& options, const StageContext& context)
    : writer_(context.output_directory / options.file, options.compression),
      topics_{.transform = writer_.add_channel<mcap_writer::Transform>("/tf"),
              .odometry = writer_.add_channel<mcap_writer::Odometry>("/odometry"),
              .state = writer_.add_channel<mcap_writer::Text>("/tracking_state"),
              .keyframe = writer_.add_channel<mcap_writer::PoseMessage>("/keyframe"),
              .path = writer_.add_channel<mcap_writer::Path>("/path"),
              .keyframes = writer_.add_channel<mcap_writer::Path>("/keyframes"),
              .landmarks = writer_.add_channel<mcap_writer::PointCloud>("/landmarks"),
              .dense_map = writer_.add_channel<mcap_writer::PointCloud>("/dense_map"),
              .voxels = writer_.add_channel<mcap_writer::Voxels>("/voxels"),
              .cost_map = writer_.add_channel<mcap_writer::OccupancyGrid>("/cost_map")},
      image_topics_(
          options.images
              ? std::optional(ImageTopics{
                    writer_.add_channel<mcap_writer::CompressedImage>(
                        "/camera/color/image_raw/compressed"),
                    writer_.add_channel<mcap_writer::CameraInfo>("/camera/color/camera_info")})
              : std::nullopt) {}

void McapOutput::frame(const FrameReport& report) {
  const double time = report.frame->time;
  writer_.write(topics_.state, time, mcap_writer::Text{name_of(report.result.state)});
  if (report.result.state == TrackState::kTracking)
    write_pose(time, report.result);
  else
    previous_.reset();
  if (image_topics_) write_image(*report.frame);
}

void McapOutput::write_pose(double time, const TrackResult& result) {
  const StampedPose now{time, map_from_world() * result.world_from_camera};
  const Header header{time, kMapFrame};
  writer_.write(topics_.transform, time,
                mcap_writer::Transform{header, kCameraFrame, now.world_from_camera});
  mcap_writer::Odometry odometry{header, kCameraFrame, now.world_from_camera};
  if (result.uncertainty)
    odometry.covariance = turned(result.uncertainty->covariance, now.world_from_camera);
  if (previous_) odometry.twist = twist_between(*previous_, now);
  writer_.write(topics_.odometry, time, odometry);
  if (result.keyframe)
    writer_.write(topics_.keyframe, time, mcap_writer::PoseMessage{header, now.world_from_camera});
  previous_ = now;
}

void McapOutput::write_image(const Frame& frame) {
  const Header header{frame.time, kCameraFrame};
  mcap_writer::CompressedImage image{header, "jpeg"};
  cv::imencode(".jpg", frame.bgr, image.file, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  writer_.write(image_topics_->image, frame.time, image);
  writer_.write(image_topics_->camera, frame.time, mcap_writer::CameraInfo{header, *frame.camera});
}

void McapOutput::finish(const RunSummary& summary) {
  if (!summary.poses.empty()) {
    const Header header{summary.poses.back().time, kMapFrame};
    write_path(summary, header);
    write_keyframes(summary.map, header);
    write_landmarks(summary.map, header);
    write_dense_map(summary, header);
    write_voxels(summary, header);
    write_cost_map(summary, header);
  }
  writer_.finish();
}

void McapOutput::write_path(const RunSummary& summary, const Header& header) {
  mcap_writer::Path path{header, {}};
  for (const TrackedPose& pose : summary.poses)
    if (const auto in_world = world_from_camera(summary.map, pose))
      path.poses.push_back({pose.time, map_from_world() * *in_world});
  writer_.write(topics_.path, header.time, path);
}

void McapOutput::write_keyframes(const SparseMap& map, const Header& header) {
  mcap_writer::Path keyframes{header, {}};
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    if (const KeyFrame* keyframe = map.keyframe(id))
      keyframes.poses.push_back({keyframe->time, map_from_world() * keyframe->world_from_camera});
  writer_.write(topics_.keyframes, header.time, keyframes);
}

void McapOutput::write_landmarks(const SparseMap& map, const Header& header) {
  mcap_writer::PointCloud cloud{header, {}, {}, {}};
  for (LandmarkId id = 0; id < map.landmark_id_end(); ++id)
    if (const Landmark* landmark = map.landmark(id))
      cloud.points.push_back(point_in_map(landmark->position_in_world));
  writer_.write(topics_.landmarks, header.time, cloud);
}

void McapOutput::write_dense_map(const RunSummary& summary, const Header& header) {
  const std::vector<LabelledPoint> points = summary.dense_map();
  if (points.empty()) return;
  mcap_writer::PointCloud cloud{header, {}, {}, {}};
  for (const LabelledPoint& point : points) {
    cloud.points.push_back(point_in_map(point.position.cast<double>()));
    cloud.rgb.push_back(rgb_of(point));
    cloud.classes.push_back(point.label);
  }
  writer_.write(topics_.dense_map, header.time, cloud);
}

/// Of the octree's file: how large they are, only that says.
void McapOutput::write_voxels(const RunSummary& summary, const Header& header) {
  const std::filesystem::path file = summary.map_directory / "map.ot";
  if (summary.map_directory.empty() || !std::filesystem::exists(file)) return;
  const semantic_octree::SavedOctree map = semantic_octree::read_octree(file);
  mcap_writer::Voxels voxels{header, map.tree->getResolution(), {}, {}};
  for (const LabelledPoint& point : semantic_octree::occupied_points(*map.tree)) {
    voxels.centres.push_back(point_in_map(point.position.cast<double>()));
    voxels.rgb.push_back(rgb_of(point));
  }
  writer_.write(topics_.voxels, header.time, voxels);
}

void McapOutput::write_cost_map(const RunSummary& summary, const Header& header) {
  if (auto grid = read_cost_map(summary.map_directory)) {
    grid->header = header;
    grid->header_from_origin = map_from_world() * grid->header_from_origin;
    writer_.write(topics_.cost_map, header.time, *grid);
  }
}

}  // namespace stillpoint::output_mcap
