#include "report/page_json.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <set>

#include "report/thinning.hpp"
#include "study/metrics.hpp"

namespace stillpoint::report {
namespace {

using Json = nlohmann::json;
using study::Table;
using study::TableCell;

/// So that numbers have as many digits as anybody can see.
double rounded(double value, double step) { return std::round(value / step) * step; }

/// As an integer count of `step`: short in JSON.
Json quantised(double value, double step) {
  return std::isfinite(value) ? Json(std::llround(value / step)) : Json();
}

constexpr double kMillimetre = 1e-3, kTenthOfMillimetre = 1e-4, kMillisecond = 1e-3,
                 kMicrosecond = 1e-3 /* ms */, kMillidegree = 1e-3, kPerMille = 1e-3;

constexpr std::size_t kStageParts = 400;  // as many as can be told apart in a stack

Json optional_json(const std::optional<double>& value) { return value ? Json(*value) : Json(); }

Json table_json(const Table& table) {
  Json rows = Json::array();
  for (const std::vector<TableCell>& cells : table.rows) {
    Json row = Json::array();
    for (const TableCell& cell : cells) {
      Json json = {{"t", cell.text}};
      if (cell.value) json["v"] = *cell.value;
      if (cell.best) json["b"] = 1;
      if (cell.significant) json["s"] = 1;
      row.push_back(std::move(json));
    }
    rows.push_back(std::move(row));
  }
  return {{"title", table.title},
          {"note", table.note},
          {"header", table.header},
          {"names", table.names},
          {"rows", rows}};
}

/// "Feature extraction" of "prepare"; empty: a stage that is none of the pipeline's own.
std::string title_of_stage(const std::string& stage) {
  for (const study::Metric& metric : study::metrics())
    if (metric.group == study::Metric::Group::kStageTimes && metric.brief == stage)
      return metric.title;
  return {};
}

/// Of all stages of the runs, by their names.
Json stage_titles(const std::vector<RunData>& runs) {
  Json titles = Json::object();
  for (const RunData& run : runs)
    for (const StageTimes& stage : run.stages) titles[stage.stage] = title_of_stage(stage.stage);
  return titles;
}

/// Mean CPU time per processed frame of each stage, for bars that compare runs; ms.
Json stage_means(const RunData& run) {
  Json means = Json::array();
  const double frames = std::max<double>(1.0, run.processed_frames.value_or(0.0));
  for (const StageTimes& stage : run.stages)
    means.push_back(
        {stage.stage,
         rounded(stage.cpu.mean * static_cast<double>(stage.calls) / frames, kMicrosecond)});
  return means;
}

Json listed_run(const RunData& run) {
  return {{"name", run.name},
          {"variant", run.variant},
          {"recording", run.recording},
          {"complete", run.complete && run.notes.empty()},
          {"ate", run.evaluation ? Json(run.evaluation->rigid.metres.rmse) : Json()},
          {"stages", stage_means(run)}};
}

Json trace_json(const RunData& run, std::size_t points) {
  Json json = {{"t", Json::array()}, {"gap", Json::array()}, {"e", Json::array()}};
  for (const char* key : {"truth", "estimate"})
    json[key] = {Json::array(), Json::array(), Json::array()};
  const auto kept =
      thinned(run.trace.size(), points, [&](std::size_t i) { return run.trace[i].error_m; });
  std::size_t before = 0;
  for (const std::size_t i : kept) {
    const TracePoint& point = run.trace[i];
    json["t"].push_back(quantised(point.seconds, kMillisecond));
    json["e"].push_back(quantised(point.error_m, kTenthOfMillimetre));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      json["truth"][axis].push_back(quantised(point.truth[a], kMillimetre));
      json["estimate"][axis].push_back(quantised(point.estimate[a], kMillimetre));
    }
    bool gap = false;  // also one before a point that was left out
    for (; before <= i; ++before) gap = gap || run.trace[before].after_gap;
    json["gap"].push_back(gap ? 1 : 0);
  }
  return json;
}

/// A path without truth: nothing but where the camera was.
Json path_json(const RunData& run, std::size_t points) {
  Json json = {{"t", Json::array()}, {"estimate", {Json::array(), Json::array(), Json::array()}}};
  for (const std::size_t i : thinned(run.path.size(), points, [](std::size_t) { return 0; })) {
    json["t"].push_back(quantised(run.path[i].time - run.path.front().time, kMillisecond));
    for (std::size_t axis = 0; axis < 3; ++axis)
      json["estimate"][axis].push_back(
          quantised(run.path[i].world_from_camera.translation()[static_cast<Eigen::Index>(axis)],
                    kMillimetre));
  }
  return json;
}

Json drift_json(const RunData& run, std::size_t points) {
  Json json = {{"t", Json::array()}, {"m", Json::array()}, {"deg", Json::array()}};
  for (const std::size_t i :
       thinned(run.drift.size(), points, [&](std::size_t k) { return run.drift[k].position_m; })) {
    json["t"].push_back(quantised(run.drift[i].seconds, kMillisecond));
    json["m"].push_back(quantised(run.drift[i].position_m, kTenthOfMillimetre));
    json["deg"].push_back(quantised(run.drift[i].rotation_deg, kMillidegree));
  }
  return json;
}

Json frames_json(const RunData& run, std::size_t points) {
  Json json = {{"t", Json::array()},       {"features", Json::array()},
               {"inliers", Json::array()}, {"matches", Json::array()},
               {"moving", Json::array()},  {"excluded", Json::array()}};
  const std::vector<FrameRow>& rows = run.frame_rows;
  for (const std::size_t i :
       thinned(rows.size(), points, [&](std::size_t k) { return rows[k].excluded; })) {
    json["t"].push_back(quantised(rows[i].seconds, kMillisecond));
    json["features"].push_back(rows[i].features);
    json["matches"].push_back(rows[i].matches);
    json["inliers"].push_back(rows[i].inliers);
    json["moving"].push_back(rows[i].moving_points ? Json(*rows[i].moving_points) : Json());
    json["excluded"].push_back(quantised(rows[i].excluded, kPerMille));
  }
  return json;
}

Json distribution_json(const Distribution& d) {
  Json json = Json::array();
  for (const double value : {d.mean, d.p50, d.p95, d.p99, d.max})
    json.push_back(rounded(value, kMicrosecond));
  return json;
}

/// Equal parts of the recording.
struct Parts {
  std::uint32_t frames = 1;
  std::size_t count = 1;
  std::size_t of(std::uint32_t frame) const { return frame * count / frames; }
};

Parts parts_of(const std::vector<StageTimes>& stages, std::size_t most) {
  Parts parts;
  for (const StageTimes& stage : stages)
    if (!stage.frame.empty()) parts.frames = std::max(parts.frames, stage.frame.back() + 1);
  parts.count = std::min<std::size_t>(most, parts.frames);
  return parts;
}

/// Of each part, the frames that were not dropped: those that some stage worked for.
std::vector<double> processed_frames(const std::vector<StageTimes>& stages, const Parts& parts) {
  std::set<std::uint32_t> processed;
  for (const StageTimes& stage : stages) processed.insert(stage.frame.begin(), stage.frame.end());
  std::vector<double> frames(parts.count);
  for (const std::uint32_t frame : processed) frames[parts.of(frame)] += 1;
  return frames;
}

/// The time per processed frame as means over parts, the same ones for all stages.
Json stages_json(const RunData& run, std::size_t points) {
  const Parts parts = parts_of(run.stages, points);
  const std::vector<double> frames = processed_frames(run.stages, parts);
  Json stages = Json::array();
  for (const StageTimes& stage : run.stages) {
    std::vector<double> wall(parts.count), cpu(parts.count);
    for (std::size_t i = 0; i < stage.frame.size(); ++i) {
      const std::size_t part = parts.of(stage.frame[i]);
      wall[part] += static_cast<double>(stage.wall_ms[i]) / frames[part];
      cpu[part] += static_cast<double>(stage.cpu_ms[i]) / frames[part];
    }
    Json json = {{"name", stage.stage},
                 {"title", title_of_stage(stage.stage)},
                 {"calls", stage.calls},
                 {"wall", distribution_json(stage.wall)},
                 {"cpu", distribution_json(stage.cpu)}};
    for (const double ms : wall) json["wall_ms"].push_back(quantised(ms, 0.01));
    for (const double ms : cpu) json["cpu_ms"].push_back(quantised(ms, 0.01));
    stages.push_back(std::move(json));
  }
  return {{"frames", parts.frames}, {"parts", parts.count}, {"list", std::move(stages)}};
}

Json facts_json(const RunData& run) {
  return {{"coverage", optional_json(run.coverage)},
          {"frames", optional_json(run.frames)},
          {"times_lost", optional_json(run.times_lost)},
          {"loops", optional_json(run.loops_closed)},
          {"keyframes", optional_json(run.keyframes)},
          {"landmarks", optional_json(run.landmarks)},
          {"dropped", optional_json(run.dropped_frames)},
          {"speed", optional_json(run.frames_per_second)},
          {"cpu", optional_json(run.cpu_ms_per_frame)},
          {"memory", optional_json(run.peak_memory_mib)},
          {"mode", run.mode}};
}

Json statistics_of(const evaluation::Statistics& s) {
  return {s.rmse, s.mean, s.median, s.standard_deviation, s.min, s.max};
}

Json errors_json(const evaluation::Evaluation& e) {
  Json json = {{"ate_m", statistics_of(e.rigid.metres)}, {"scale", optional_json(e.scale)}};
  if (e.rigid_rotation_deg) json["ate_deg"] = statistics_of(*e.rigid_rotation_deg);
  if (e.relative) {
    json["rpe_m"] = statistics_of(e.relative->translation_m);
    json["rpe_deg"] = statistics_of(e.relative->rotation_deg);
  }
  return json;
}

template <class Number>
void append_little_endian(std::string& bytes, const std::vector<Number>& numbers) {
  for (const Number number : numbers)
    for (std::size_t i = 0; i < sizeof(Number); ++i)
      bytes += static_cast<char>(number >> (8 * i) & 0xff);
}

}  // namespace

Json report_json(const ReportData& data, const std::string& written_by) {
  Json tables = Json::array(), runs = Json::array();
  for (const Table& table : data.tables) tables.push_back(table_json(table));
  for (const RunData& run : data.runs) runs.push_back(listed_run(run));
  return {{"title", data.title},
          {"question", data.question},
          {"command", data.command},
          {"origins", data.origins},
          {"notes", data.notes},
          {"tables", tables},
          {"runs", runs},
          {"stage_titles", stage_titles(data.runs)},
          {"written_by", written_by}};
}

Json run_json(const RunData& run, std::size_t points) {
  Json json = {{"name", run.name},
               {"recording", run.recording},
               {"folder", run.folder.string()},
               {"made_by", run.made_by},
               {"notes", run.notes},
               {"facts", facts_json(run)},
               {"frames", frames_json(run, points)},
               {"stages", stages_json(run, std::min(points, kStageParts))},
               {"loops", run.loops},
               {"yaml", run.yaml},
               {"base", run.base}};
  if (run.evaluation) json["errors"] = errors_json(*run.evaluation);
  json["trace"] = run.trace.empty() ? path_json(run, points) : trace_json(run, points);
  if (!run.octree.empty()) json["path"] = path_json(run, points);  // in the map's world
  json["drift"] = drift_json(run, points);
  json["lost"] = Json::array();
  for (const Interval& interval : run.lost) json["lost"].push_back({interval.begin, interval.end});
  json["changes"] = Json::array();
  for (const OptionChange& change : run.changes)
    json["changes"].push_back({change.key, change.base, change.value});
  return json;
}

Json map_json(const MapVoxels& voxels) {
  const auto vector = [](const Eigen::Vector3d& v) { return Json{v.x(), v.y(), v.z()}; };
  Json classes = Json::array();
  for (std::size_t i = 0; i < voxels.classes.names.size(); ++i)
    classes.push_back({{"name", voxels.classes.names.at(i)}, {"color", voxels.classes.colors[i]}});
  return {{"edge", voxels.edge},
          {"resolution", voxels.resolution},
          {"corner", vector(voxels.corner)},
          {"up", vector(voxels.up)},
          {"occupied", voxels.occupied},
          {"shown", voxels.size()},
          {"colors", voxels.has_colors},
          {"classes", classes}};
}

std::string map_bytes(const MapVoxels& voxels) {
  std::string bytes;
  bytes.reserve(11 * voxels.size());
  for (const auto* axis : {&voxels.x, &voxels.y, &voxels.z}) append_little_endian(bytes, *axis);
  for (const auto* plane :
       {&voxels.red, &voxels.green, &voxels.blue, &voxels.label, &voxels.occupancy})
    append_little_endian(bytes, *plane);
  return bytes;
}

}  // namespace stillpoint::report
