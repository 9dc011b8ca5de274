#include "report/figures.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "figures/error_figure.hpp"
#include "figures/feature_figure.hpp"
#include "figures/figure_file.hpp"
#include "figures/share_figure.hpp"
#include "figures/time_figure.hpp"
#include "figures/trajectory_figure.hpp"

namespace stillpoint::report {
namespace {

using figures::Course;

/// A run under the name that it has in figures.
struct NamedRun {
  std::string name;
  const RunData* data;
};
using NamedRuns = std::vector<NamedRun>;

/// By recording, of each variant the first run; runs of one name are told apart.
std::map<std::string, NamedRuns> runs_by_recording(const ReportData& data) {
  std::map<std::string, NamedRuns> recordings;
  for (const RunData& run : data.runs) {
    NamedRuns& runs = recordings[run.recording.empty() ? "recording" : run.recording];
    const auto same = std::ranges::count_if(
        runs, [&](const NamedRun& other) { return other.data->variant == run.variant; });
    if (same == 0)
      runs.push_back({run.variant, &run});
    else if (run.variant == run.name)
      runs.push_back({run.variant + " " + std::to_string(same + 1), &run});
  }
  return recordings;
}

std::vector<figures::Range> lost_of(const RunData& run) {
  std::vector<figures::Range> lost;
  for (const Interval& stretch : run.lost) lost.push_back({stretch.begin, stretch.end});
  return lost;
}

figures::RunPath path_of(const NamedRun& run) {
  figures::RunPath path{run.name, {}, {}, {}, lost_of(*run.data)};
  for (const TracePoint& point : run.data->trace) {
    if (point.after_gap && !path.seconds.empty())  // also where only the truth is missing
      path.lost.push_back({path.seconds.back(), point.seconds});
    path.seconds.push_back(point.seconds);
    path.truth.push_back(point.truth);
    path.estimate.push_back(point.estimate);
  }
  if (!run.data->trace.empty()) return path;
  for (const StampedPose& pose : run.data->path) {
    path.seconds.push_back(pose.time - run.data->path.front().time);
    path.estimate.push_back(pose.world_from_camera.translation());
  }
  return path;
}

/// A value of each element over its time.
template <class Element, class Value>
Course course_of(const std::vector<Element>& elements, Value value) {
  Course course;
  for (const Element& element : elements) {
    course.seconds.push_back(element.seconds);
    course.values.push_back(static_cast<double>(element.*value));
  }
  return course;
}

figures::RunErrors errors_of(const NamedRun& run) {
  const RunData& data = *run.data;
  return {run.name,
          course_of(data.trace, &TracePoint::error_m),
          course_of(data.drift, &DriftPoint::position_m),
          course_of(data.drift, &DriftPoint::rotation_deg),
          lost_of(data),
          data.loops};
}

figures::RunShare share_of(const NamedRun& run) {
  return {run.name, course_of(run.data->frame_rows, &FrameRow::excluded), lost_of(*run.data)};
}

/// Waiting, and what contains other stages, would count twice.
bool counts(const StageTimes& stage) {
  return !stage.stage.ends_with("_wait") && stage.stage != "track_thread";
}

figures::RunTimes times_of(const NamedRun& run) {
  figures::RunTimes times{run.name, {}};
  const double frames = std::max(run.data->processed_frames.value_or(0), 1.0);
  for (const StageTimes& stage : run.data->stages)
    if (counts(stage))
      times.stages.push_back({stage.stage,
                              stage.cpu.mean * static_cast<double>(stage.calls) / frames,
                              stage.wall.p50, stage.wall.p95, stage.wall.p99});
  return times;
}

/// Of each variant the mean over its runs; a stage that a run does not have costs it nothing.
std::vector<figures::RunTimes> times_of_variants(const ReportData& data) {
  std::vector<figures::RunTimes> variants;
  std::map<std::string, double> counts;
  for (const RunData& run : data.runs) {
    if (run.stages.empty()) continue;
    counts[run.variant] += 1;
    auto variant = std::ranges::find(variants, run.variant, &figures::RunTimes::name);
    if (variant == variants.end()) variant = variants.insert(variants.end(), {run.variant, {}});
    for (const figures::StageTime& time : times_of({run.variant, &run}).stages) {
      const auto known = std::ranges::find(variant->stages, time.stage, &figures::StageTime::stage);
      if (known == variant->stages.end())
        variant->stages.push_back({time.stage, time.mean_per_frame});
      else
        known->mean_per_frame += time.mean_per_frame;
    }
  }
  for (figures::RunTimes& variant : variants)
    for (figures::StageTime& time : variant.stages) time.mean_per_frame /= counts[variant.name];
  return variants;
}

std::vector<figures::StageCourse> stage_courses(const RunData& run) {
  std::vector<figures::StageCourse> courses;
  for (const StageTimes& stage : run.stages)
    if (counts(stage) && !stage.frame.empty())
      courses.push_back({stage.stage,
                         {stage.frame.begin(), stage.frame.end()},
                         {stage.cpu_ms.begin(), stage.cpu_ms.end()}});
  return courses;
}

bool excludes_anything(const RunData& run) {
  return std::ranges::any_of(run.frame_rows, [](const FrameRow& row) { return row.excluded > 0; });
}

/// What `has` holds for, as a figure shows it.
template <class Has, class Convert>
auto converted(const NamedRuns& runs, Has has, Convert convert) {
  std::vector<decltype(convert(runs.front()))> result;
  for (const NamedRun& run : runs)
    if (has(*run.data)) result.push_back(convert(run));
  return result;
}

/// A name from anywhere as one part of a path.
std::string as_file_name(std::string name) {
  std::ranges::replace_if(
      name, [](unsigned char c) { return c <= ' ' || c == '/' || c == '\\'; }, '_');
  return name.empty() || name == "." || name == ".." ? "_" : name;
}

class Writer {
 public:
  explicit Writer(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The figures that show one run as well as several; less than `least` runs with data: none.
  void write_common(const NamedRuns& runs, std::size_t least) {
    const auto paths = converted(
        runs, [](const RunData& run) { return !run.trace.empty(); }, path_of);
    if (paths.size() >= least) write("trajectory", figures::trajectory_figure(paths));
    const auto errors = converted(
        runs, [](const RunData& run) { return !run.trace.empty(); }, errors_of);
    if (errors.size() >= least) write("errors", figures::error_figure(errors, "1 s"));
    const auto shares = converted(runs, excludes_anything, share_of);
    if (shares.size() >= least) write("excluded", figures::share_figure(shares));
    const auto times = converted(
        runs, [](const RunData& run) { return !run.stages.empty(); }, times_of);
    if (times.size() >= least) write("stage_times", figures::stage_time_figure(times));
  }

  /// Of all recordings together.
  void write_variants(const ReportData& data) {
    const std::vector<figures::RunTimes> variants = times_of_variants(data);
    if (variants.size() > 1) write("stage_times", figures::variant_time_figure(variants));
  }

  void write_run(const NamedRun& run) {
    const RunData& data = *run.data;
    write_common({run}, 1);
    if (data.trace.empty() && !data.path.empty())
      write("trajectory", figures::trajectory_figure(std::vector{path_of(run)}));
    if (!data.frame_rows.empty())
      write("features", figures::feature_figure({course_of(data.frame_rows, &FrameRow::features),
                                                 course_of(data.frame_rows, &FrameRow::matches),
                                                 course_of(data.frame_rows, &FrameRow::inliers),
                                                 lost_of(data)}));
    const std::vector<figures::StageCourse> courses = stage_courses(data);
    if (!courses.empty()) write("frame_times", figures::frame_time_figure(courses));
  }

  std::size_t count() const { return count_; }

 private:
  void write(const std::string& name, const figures::Figure& figure) {
    for (const char* ending : {".svg", ".pdf"})
      figures::write_figure(figure, folder_ / (name + ending));
    ++count_;
  }

  std::filesystem::path folder_;
  std::size_t count_ = 0;
};

}  // namespace

std::size_t write_figures(const ReportData& data, const std::filesystem::path& folder) {
  Writer over_all(folder);
  over_all.write_variants(data);
  std::size_t count = over_all.count();
  for (const auto& [recording, runs] : runs_by_recording(data)) {
    const std::filesystem::path place = folder / as_file_name(recording);
    Writer together(place);
    const auto most = static_cast<std::ptrdiff_t>(std::min(runs.size(), figures::kRunColours));
    together.write_common({runs.begin(), runs.begin() + most}, 2);
    count += together.count();
    for (const NamedRun& run : runs) {
      Writer alone(place / as_file_name(run.name));
      alone.write_run(run);
      count += alone.count();
    }
  }
  return count;
}

}  // namespace stillpoint::report
