// run.mcap: what a run finds, as messages of ROS 2.
#pragma once

#include <memory>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <string>

#include "ros2_messages/mcap_writer.hpp"
#include "ros2_messages/pose_messages.hpp"

namespace stillpoint::output_mcap {

using ros2_messages::ChannelId;
using ros2_messages::Compression;
using ros2_messages::Header;
using ros2_messages::McapWriter;

/// Written as the run goes: tf, odometry and state of every frame, a pose for each key frame,
/// images on request. At the end, with the time of the last frame: path, key frames, landmarks,
/// dense map, voxels and cost map as they have become.
class McapOutput final : public Output {
 public:
  struct Options {
    std::string file = "run.mcap";
    bool images = false;
    Compression compression = Compression::kZstd;

    void visit(OptionVisitor& v) {
      v("file", file, {.help = "name of the file in the run folder"});
      v("images", images, {.help = "the colour images as well, as JPEG"});
      v.choice(
          "compression", compression,
          {{"zstd", Compression::kZstd}, {"lz4", Compression::kLz4}, {"none", Compression::kNone}},
          {.help = "of the file"});
    }
  };

  McapOutput(const Options& options, const StageContext& context);

  void frame(const FrameReport& report) override;
  void finish(const RunSummary& summary) override;

 private:
  struct Topics {
    ChannelId transform, odometry, state, keyframe, path, keyframes, landmarks, dense_map, voxels,
        cost_map;
  };
  struct ImageTopics {
    ChannelId image, camera;
  };

  void write_pose(double time, const TrackResult& result);
  void write_image(const Frame& frame);
  void write_keyframes(const SparseMap& map, const Header& header);
  void write_voxels(const RunSummary& summary, const Header& header);
  void write_cost_map(const RunSummary& summary, const Header& header);

  McapWriter writer_;
  const Topics topics_;
  const std::optional<ImageTopics> image_topics_;
  const ros2_messages::Mounting mounting_;
  ros2_messages::PoseSequence poses_{mounting_};
};

}  // namespace stillpoint::output_mcap
