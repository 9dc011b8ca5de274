// run.mcap: what a run finds, as messages of ROS 2.
#pragma once

#include <memory>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <string>
#include <vector>

#include "ros2_messages/mcap_writer.hpp"
#include "ros2_messages/pose_messages.hpp"

namespace stillpoint::output_mcap {

using ros2_messages::ChannelId;
using ros2_messages::Compression;
using ros2_messages::Header;
using ros2_messages::McapWriter;

/// Written as the run goes: tf, odometry and state of every frame, a pose for each key frame,
/// images on request; from time to time key frames, landmarks and dense map as they are then. At
/// the end, with the time of the last frame: these, path, voxels and cost map.
class McapOutput final : public Output {
 public:
  struct Options {
    std::string file = "run.mcap";
    bool images = false;
    double map_period = 5.0;  ///< seconds; 0: at the end only
    Compression compression = Compression::kZstd;

    void visit(OptionVisitor& v) {
      v("file", file, {.help = "name of the file in the run folder"});
      v("images", images, {.help = "write the colour images, too, as JPEG"});
      v("map_period", map_period,
        {.min = 0,
         .unit = "s",
         .help = "time between two states of key frames, landmarks and dense map in the file; 0: "
                 "the last one only; smaller: a larger file"});
      v.choice(
          "compression", compression,
          {{"zstd", Compression::kZstd}, {"lz4", Compression::kLz4}, {"none", Compression::kNone}},
          {.help = "compression of the messages in the file"});
    }
  };

  McapOutput(const Options& options, const StageContext& context);

  void begin(const std::shared_ptr<LiveRun>& run) override { run_ = run; }
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
  void write_landmarks(const SparseMap& map, const Header& header);
  void write_dense_map(const std::vector<LabelledPoint>& points, const Header& header);
  void write_map_so_far(const FrameReport& report);
  void write_keyframes(const SparseMap& map, const Header& header);
  void write_voxels(const RunSummary& summary, const Header& header);
  void write_cost_map(const RunSummary& summary, const Header& header);

  const double map_period_;
  McapWriter writer_;
  const Topics topics_;
  const std::optional<ImageTopics> image_topics_;
  const ros2_messages::Mounting mounting_;
  ros2_messages::PoseSequence poses_{mounting_};
  std::shared_ptr<LiveRun> run_;
  std::optional<double> next_map_, next_dense_map_;  // seconds; none before the first frame
};

}  // namespace stillpoint::output_mcap
