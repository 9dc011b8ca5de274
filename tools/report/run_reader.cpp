#include "report/run_reader.hpp"

#include <algorithm>
#include <array>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>

#include "evaluation/coverage.hpp"
#include "report/frame_log.hpp"
#include "report/option_changes.hpp"
#include "report/picture_choice.hpp"
#include "stillpoint/error.hpp"
#include "study/text_file.hpp"

namespace stillpoint::report {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;
using evaluation::Trajectory;

std::optional<double> number(const Json& json, const char* key) {
  const auto found = json.find(key);
  if (found == json.end() || !found->is_number()) return std::nullopt;
  return found->get<double>();
}

std::string text(const Json& json, const char* key) {
  const auto found = json.find(key);
  return found != json.end() && found->is_string() ? found->get<std::string>() : "";
}

void take_summary(RunData& run, const Json& json) {
  const std::pair<const char*, std::optional<double>*> figures[] = {
      {"coverage", &run.coverage},
      {"frames", &run.frames},
      {"processed_frames", &run.processed_frames},
      {"times_lost", &run.times_lost},
      {"loops_closed", &run.loops_closed},
      {"keyframes", &run.keyframes},
      {"landmarks", &run.landmarks},
      {"dropped_frames", &run.dropped_frames},
      {"cpu_ms_per_frame", &run.cpu_ms_per_frame},
      {"peak_memory_mib", &run.peak_memory_mib}};
  for (const auto& [key, figure] : figures) *figure = number(json, key);
  const auto seconds = number(json, "wall_seconds");
  if (run.processed_frames && seconds && *seconds > 0.0)
    run.frames_per_second = *run.processed_frames / *seconds;
  run.mode = text(json, "mode");
  if (json.contains("versions")) run.made_by = "Stillpoint " + text(json["versions"], "stillpoint");
  run.complete = json.value("complete", false);
  const std::string failure = text(json, "failure");
  if (!failure.empty()) run.notes.push_back("The run failed: " + failure);
  if (!run.complete && failure.empty())
    run.notes.emplace_back("The run was stopped before the end of its recording.");
}

void read_summary(RunData& run) {
  const fs::path file = run.folder / "summary.json";
  const std::string content = study::read_text(file);
  if (content.empty()) {
    run.notes.emplace_back(
        "summary.json is missing: the run has not ended, or its pipeline has no "
        "such output.");
    return;
  }
  const Json json = Json::parse(content, nullptr, false);
  if (json.is_object())
    take_summary(run, json);
  else
    run.notes.emplace_back("summary.json cannot be read: it is no JSON object.");
}

/// The pipeline's file and the build, from the first two lines of log.txt: "DATE TIME  info  …".
void read_log(RunData& run) {
  constexpr std::string_view kLevel = "  info  ";
  constexpr std::streamsize kLogBeginning = 4096;  // bytes: longer lines than a log has
  std::error_code none;
  if (!std::filesystem::is_regular_file(run.folder / "log.txt", none)) return;
  std::string beginning(kLogBeginning, '\0');
  std::ifstream file(run.folder / "log.txt");
  file.read(beginning.data(), kLogBeginning);
  beginning.resize(static_cast<std::size_t>(file.gcount()));
  std::istringstream log(beginning);
  const auto next = [&] {
    std::string line;
    std::getline(log, line);
    const std::size_t level = line.find(kLevel);
    return level == std::string::npos ? "" : line.substr(level + kLevel.size());
  };
  const std::string first = next(), second = next();
  if (const std::size_t comma = first.find(", "); comma != std::string::npos)
    run.pipeline = first.substr(comma + 2);
  if (second.starts_with("by ")) run.made_by = second.substr(3);
}

/// Calls `read`; its error becomes a note.
template <class Read>
void try_to(RunData& run, Read&& read) {
  try {
    read();
  } catch (const std::exception& error) {
    run.notes.emplace_back(error.what());
  }
}

void read_pipeline(RunData& run) {
  run.yaml = study::read_text(run.folder / "pipeline.yaml");
  if (run.yaml.empty()) run.notes.emplace_back("pipeline.yaml is missing.");
  if (run.dataset.empty()) run.dataset = recording_of_pipeline(run.yaml);
  // The source may be live, or simulate.
  run.recording = run.dataset.empty() ? "without a folder" : run.dataset.filename().string();
}

/// Looks for the true trajectory beside the images, where none was given.
void find_truth(RunData& run) {
  if (!run.truth.empty() || run.dataset.empty()) return;
  std::error_code unreadable;
  if (const fs::path truth = run.dataset / "groundtruth.txt"; fs::exists(truth, unreadable))
    run.truth = truth;
}

void take_errors(RunData& run) {
  const evaluation::Evaluation& e = *run.evaluation;
  const double start = e.reference.start(), longest = evaluation::longest_interval(e.estimate);
  for (std::size_t i = 0; i < e.pairs.size(); ++i) {
    const auto& [r, k] = e.pairs[i];
    TracePoint point{
        .seconds = e.reference.poses[r].time - start,
        .truth = e.reference.poses[r].world_from_camera.translation(),
        .estimate = evaluation::aligned(e.rigid.reference_from_estimate, e.estimate.poses[k]),
        .error_m = e.rigid.per_pair[i]};
    point.after_gap = i > 0 && point.seconds - run.trace.back().seconds > longest;
    run.trace.push_back(point);
  }
  if (!e.relative) return;
  for (const evaluation::MotionError& motion : e.relative->per_pair)
    run.drift.push_back({motion.time - start, motion.translation_m, motion.rotation_deg});
}

/// Where the recording's clock begins in the report: with the truth, or else the first frame.
double start_of(const RunData& run) {
  if (run.evaluation) return run.evaluation->reference.start();
  if (!run.frame_rows.empty()) return run.frame_rows.front().time;
  return run.path.empty() ? 0.0 : run.path.front().time;
}

std::vector<Interval> lost_by_frames(const std::vector<FrameRow>& rows) {
  std::vector<Interval> lost;
  bool open = false;
  for (const FrameRow& row : rows) {
    if (open) lost.back().end = row.seconds;
    if (!row.tracked && !open) lost.push_back({row.seconds, row.seconds});
    open = !row.tracked;
  }
  return lost;
}

/// Without frames.csv: gaps between poses, and before the first and after the last.
std::vector<Interval> lost_by_gaps(const evaluation::Evaluation& e) {
  const double longest = evaluation::longest_interval(e.estimate), start = e.reference.start();
  std::vector<Interval> lost;
  double last = start;
  const auto look = [&](double time) {
    if (time - last > longest) lost.push_back({last - start, time - start});
    last = time;
  };
  for (const StampedPose& pose : e.estimate.poses) look(pose.time);
  look(e.reference.end());
  return lost;
}

void take_events(RunData& run) {
  const double start = start_of(run);
  for (FrameRow& row : run.frame_rows) row.seconds = row.time - start;
  if (!run.frame_rows.empty())
    run.lost = lost_by_frames(run.frame_rows);
  else if (run.evaluation)
    run.lost = lost_by_gaps(*run.evaluation);
  // The map is adjusted once after each loop, for the key frame that closed it.
  const auto adjust = std::ranges::find(run.stages, "loop_adjust", &StageTimes::stage);
  if (adjust == run.stages.end()) return;
  for (const std::uint32_t frame : adjust->frame) {
    const auto row = std::ranges::lower_bound(run.frame_rows, frame, {}, &FrameRow::frame);
    if (row != run.frame_rows.end()) run.loops.push_back(row->seconds);
  }
}

/// Why there is nothing to compare with.
std::string without_truth(const fs::path& recording) {
  std::error_code unreadable;
  if (recording.empty()) return "The recording has no true trajectory: no errors.";
  if (!fs::exists(recording, unreadable))
    return "The recording is not at " + recording.string() + ": no errors.";
  return "There is no groundtruth.txt in " + recording.string() + ": no errors.";
}

void read_trajectory(RunData& run) {
  const fs::path file = run.folder / "trajectory.txt";
  if (!fs::exists(file)) {
    run.notes.emplace_back("trajectory.txt is missing.");
    return;
  }
  Trajectory trajectory = evaluation::read_trajectory(file);
  run.path = trajectory.poses;
  if (run.truth.empty()) {
    run.notes.push_back(without_truth(run.dataset));
    return;
  }
  run.evaluation =
      evaluation::evaluate(evaluation::read_trajectory(run.truth), std::move(trajectory), {}, {});
  take_errors(run);
}

/// Those that were tracked in a map which the tracker gave up later.
void mark_frames_without_pose(RunData& run) {
  if (run.path.empty()) return;
  constexpr double kRounding = 1e-5;  // seconds, of times in files
  for (FrameRow& row : run.frame_rows)
    if (row.time < run.path.front().time - kRounding) row.tracked = false;
}

}  // namespace

bool is_run(const fs::path& folder) {
  constexpr std::array kFiles = {"summary.json", "trajectory.txt", "pipeline.yaml"};
  std::error_code unreadable;
  return std::ranges::any_of(
      kFiles, [&](const char* file) { return fs::exists(folder / file, unreadable); });
}

RunData read_run(const fs::path& folder, const std::string& name, const RunInputs& inputs) {
  RunData run{.name = name,
              .variant = name,
              .folder = folder,
              .dataset = inputs.dataset,
              .truth = inputs.truth};
  try_to(run, [&] { read_summary(run); });
  read_log(run);
  try_to(run, [&] { read_pipeline(run); });
  find_truth(run);
  try_to(run, [&] { read_trajectory(run); });
  try_to(run, [&] { run.frame_rows = read_frames(folder / "frames.csv"); });
  mark_frames_without_pose(run);
  try_to(run, [&] { run.stages = read_stage_times(folder / "timings.csv"); });
  take_events(run);
  choose_pictures(run);
  std::error_code unreadable;
  if (const fs::path map = folder / "map/map.ot"; fs::exists(map, unreadable)) run.octree = map;
  const fs::path live_view = fs::path(live_view_of_pipeline(run.yaml)).filename();
  if (!live_view.empty() && fs::is_regular_file(folder / live_view, unreadable))
    run.live_view = folder / live_view;
  return run;
}

void compare_options(RunData& run, const std::string& base, const std::string& base_yaml) {
  if (run.yaml.empty() || base_yaml.empty()) return;
  try_to(run, [&] {
    run.changes = option_changes(base_yaml, run.yaml);
    run.base = base;
  });
}

}  // namespace stillpoint::report
