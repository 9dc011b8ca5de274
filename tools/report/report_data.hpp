// What a report shows: plain figures, read from run folders and studies, before anything is drawn.
// Metres, seconds since the recording's first true pose, milliseconds; nothing here is thinned out.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/evaluation.hpp"
#include "stillpoint/support/run_statistics.hpp"
#include "study/table.hpp"

namespace stillpoint::report {

/// A tracked frame beside the truth, after SE(3) alignment.
struct TracePoint {
  double seconds = 0;
  Eigen::Vector3d truth{0, 0, 0}, estimate{0, 0, 0};  ///< in the truth's world
  double error_m = 0;
  bool after_gap = false;  ///< frames without a pose lie before this one: lines break here
};

/// Error of the motion over the next second, see evaluation/relative_error.hpp.
struct DriftPoint {
  double seconds = 0;
  double position_m = 0;
  double rotation_deg = 0;
};

/// A row of frames.csv.
struct FrameRow {
  std::uint32_t frame = 0;
  double time = 0;  ///< seconds on the recording's clock
  double seconds = 0;
  bool tracked = false;
  int features = 0, matches = 0, inliers = 0;
  std::optional<int> moving_points;  ///< nothing: not known for this frame
  double excluded = 0;               ///< share of the pixels that tracking does not use, 0 … 1
};

struct Interval {
  double begin = 0, end = 0;
};

/// One stage of timings.csv: the time of all its calls for a frame.
struct StageTimes {
  std::string stage;
  std::size_t calls = 0;
  Distribution wall, cpu;              ///< of single calls
  std::vector<std::uint32_t> frame;    ///< rising; the frames that it worked for
  std::vector<float> wall_ms, cpu_ms;  ///< parallel to `frame`
};

/// An option whose value differs from that of the base. Empty: not there.
struct OptionChange {
  std::string key;  ///< "tracker.features"
  std::string base, value;
};

/// A picture that the output `images` has left, or the recording's own.
struct Picture {
  std::uint32_t frame = 0;
  std::filesystem::path file;
  std::string why;        ///< "largest error: 42.0 mm"; empty: one of the evenly chosen
  std::string state;      ///< what tracking had of the frame, in words
  bool recorded = false;  ///< as the camera gave it: the run has drawn none of the frame
};

struct RunData {
  std::string name;       ///< of the folder, or SEQUENCE/VARIANT/REPEAT
  std::string variant;    ///< of a study, which may have run it several times; else as `name`
  std::string recording;  ///< name of its sequence, or of the recording's folder
  std::filesystem::path folder;
  std::filesystem::path dataset;   ///< the recording, folder or bag; empty: none found
  std::filesystem::path truth;     ///< true trajectory; empty: none found
  std::filesystem::path pipeline;  ///< the file that was run; empty: not known
  std::string made_by;  ///< "Stillpoint 0.1.0, commit …; machine; date", as far as known
  bool complete = false;
  std::vector<std::string> notes;  ///< what failed or is missing, a sentence each

  // Of summary.json; nothing without it.
  std::optional<double> coverage;  ///< 0 … 1
  std::optional<double> frames, processed_frames, times_lost, loops_closed, keyframes, landmarks,
      dropped_frames, frames_per_second, cpu_ms_per_frame, peak_memory_mib;
  std::string mode;

  /// Nothing: no truth, or nothing to compare.
  std::optional<evaluation::Evaluation> evaluation;
  std::vector<StampedPose> path;  ///< trajectory.txt, where there is no evaluation
  std::vector<TracePoint> trace;
  std::vector<DriftPoint> drift;
  std::vector<FrameRow> frame_rows;
  std::vector<Interval> lost;      ///< stretches of the recording without a pose
  std::vector<double> loops;       ///< when the key frame that closed a loop was seen
  std::vector<StageTimes> stages;  ///< in the order of the pipeline

  std::string yaml;  ///< effective pipeline
  std::string base;  ///< what the changes are against, for a heading
  std::vector<OptionChange> changes;
  std::vector<Picture> pictures;
  std::filesystem::path octree;     ///< map/map.ot; empty: none
  std::filesystem::path live_view;  ///< recorded by an output `web`; empty: none
};

struct ReportData {
  std::string title;
  std::string question;  ///< of the study; may be empty
  std::string command;   ///< of the study, or that makes a report of runs again; may be empty
  std::vector<std::string> origins;  ///< which builds made the runs, where and when
  std::vector<std::string> notes;    ///< what is incomplete
  std::vector<study::Table> tables;
  std::vector<RunData> runs;
};

}  // namespace stillpoint::report
