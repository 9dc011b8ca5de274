#include "output_mcap/mcap_output.hpp"

#include <utility>
#include <vector>

#include "ros2_messages/cost_map_file.hpp"
#include "ros2_messages/point_clouds.hpp"
#include "semantic_octree/octree_reader.hpp"
#include "stillpoint/support/image_codec.hpp"

namespace stillpoint::output_mcap {
namespace {

using ros2_messages::kCameraFrame;

constexpr int kJpegQuality = 85;  // per cent

}  // namespace

McapOutput::McapOutput(const Options& options, const StageContext& context)
    : map_period_(options.map_period),
      writer_(context.output_directory / options.file, options.compression),
      topics_{.transform = writer_.add_channel<ros2_messages::Transform>("/tf"),
              .odometry = writer_.add_channel<ros2_messages::Odometry>("/odometry"),
              .state = writer_.add_channel<ros2_messages::Text>("/tracking_state"),
              .keyframe = writer_.add_channel<ros2_messages::PoseMessage>("/keyframe"),
              .path = writer_.add_channel<ros2_messages::Path>("/path"),
              .keyframes = writer_.add_channel<ros2_messages::Path>("/keyframes"),
              .landmarks = writer_.add_channel<ros2_messages::PointCloud>("/landmarks"),
              .dense_map = writer_.add_channel<ros2_messages::PointCloud>("/dense_map"),
              .voxels = writer_.add_channel<ros2_messages::Voxels>("/voxels"),
              .cost_map = writer_.add_channel<ros2_messages::OccupancyGrid>("/cost_map")},
      image_topics_(
          options.images
              ? std::optional(ImageTopics{
                    writer_.add_channel<ros2_messages::CompressedImage>(
                        "/camera/color/image_raw/compressed"),
                    writer_.add_channel<ros2_messages::CameraInfo>("/camera/color/camera_info")})
              : std::nullopt) {}

void McapOutput::frame(const FrameReport& report) {
  const double time = report.frame->time;
  writer_.write(topics_.state, time, ros2_messages::Text{name_of(report.result.state)});
  write_pose(time, report.result);
  if (image_topics_) write_image(*report.frame);
  if (map_period_ > 0) write_map_so_far(report);
}

void McapOutput::write_map_so_far(const FrameReport& report) {
  const double time = report.frame->time;
  const Header header{time, mounting_.map};
  if (!next_map_) next_map_ = next_dense_map_ = time + map_period_;
  if (time >= *next_map_) {
    write_keyframes(*report.map, header);
    write_landmarks(*report.map, header);
    next_map_ = time + map_period_;
  }
  if (!run_ || time < *next_dense_map_) return;
  const auto points = run_->dense_map();
  if (!points || points->empty()) return;  // with a later frame
  write_dense_map(*points, header);
  next_dense_map_ = time + map_period_;
}

void McapOutput::write_pose(double time, const TrackResult& result) {
  const auto messages = poses_.next(time, result);
  if (!messages) return;
  writer_.write(topics_.transform, time, messages->transform);
  writer_.write(topics_.odometry, time, messages->odometry);
  if (result.keyframe) writer_.write(topics_.keyframe, time, messages->pose);
}

void McapOutput::write_image(const Frame& frame) {
  const Header header{frame.time, kCameraFrame};
  ros2_messages::CompressedImage image{header, "jpeg"};
  image.file = encode_image(".jpg", frame.bgr, {cv::IMWRITE_JPEG_QUALITY, kJpegQuality});
  writer_.write(image_topics_->image, frame.time, image);
  writer_.write(image_topics_->camera, frame.time,
                ros2_messages::CameraInfo{header, *frame.camera});
}

void McapOutput::finish(const RunSummary& summary) {
  run_.reset();
  if (!summary.poses.empty()) {
    const Header header{summary.poses.back().time, mounting_.map};
    writer_.write(topics_.path, header.time,
                  ros2_messages::path_of(summary.map, summary.poses, mounting_, header.time));
    write_keyframes(summary.map, header);
    write_landmarks(summary.map, header);
    if (const auto points = summary.dense_map(); !points.empty()) write_dense_map(points, header);
    write_voxels(summary, header);
    write_cost_map(summary, header);
  }
  writer_.finish();
}

void McapOutput::write_landmarks(const SparseMap& map, const Header& header) {
  writer_.write(topics_.landmarks, header.time,
                ros2_messages::landmark_cloud(map, mounting_, header.time));
}

void McapOutput::write_dense_map(const std::vector<LabelledPoint>& points, const Header& header) {
  writer_.write(topics_.dense_map, header.time,
                ros2_messages::dense_cloud(points, mounting_, header.time));
}

void McapOutput::write_keyframes(const SparseMap& map, const Header& header) {
  ros2_messages::Path keyframes{header, {}};
  for (KeyFrameId id = 0; id < map.keyframe_id_end(); ++id)
    if (const KeyFrame* keyframe = map.keyframe(id))
      keyframes.poses.push_back(
          {keyframe->time, mounting_.map_from_base(keyframe->world_from_camera)});
  writer_.write(topics_.keyframes, header.time, keyframes);
}

/// Of the octree's file: how large they are, only that says.
void McapOutput::write_voxels(const RunSummary& summary, const Header& header) {
  const std::filesystem::path file = summary.map_directory / "map.ot";
  if (summary.map_directory.empty() || !std::filesystem::exists(file)) return;
  const semantic_octree::SavedOctree map = semantic_octree::read_octree(file);
  ros2_messages::Voxels voxels{header, map.tree->getResolution(), {}, {}};
  for (const LabelledPoint& point : semantic_octree::occupied_points(*map.tree)) {
    voxels.centres.push_back(ros2_messages::point_in_map(mounting_, point.position.cast<double>()));
    voxels.rgb.push_back(ros2_messages::rgb_of(point));
  }
  writer_.write(topics_.voxels, header.time, voxels);
}

void McapOutput::write_cost_map(const RunSummary& summary, const Header& header) {
  if (auto grid = ros2_messages::read_cost_map(summary.map_directory)) {
    grid->header = header;
    grid->header_from_origin = mounting_.map_from_world * grid->header_from_origin;
    writer_.write(topics_.cost_map, header.time, *grid);
  }
}

}  // namespace stillpoint::output_mcap
