#include "evaluation/report.hpp"

#include <nlohmann/json.hpp>
#include <sstream>

#include "evaluation/format.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr int kLabelWidth = 30;
constexpr int kUnitColumn = 26;
constexpr int kColumnWidth = 12;
constexpr int kDigits = 6;  // as the benchmark's scripts print

std::string padded(const std::string& text, std::size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text;
}

std::string percent(double share) { return fixed(100.0 * share, 1) + " %"; }

// 1 → "1", 0.5 → "0.5"
std::string shortest(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

std::string delta_text(const Delta& delta) {
  const std::string length = shortest(delta.length);
  if (delta.unit != DeltaUnit::kFrames) return length + " " + symbol_of(delta.unit);
  return length + (delta.length == 1 ? " frame" : " frames");
}

std::string file_line(const char* role, const Trajectory& t) {
  std::string line = padded(role, 11) + t.name + ": " + std::to_string(t.poses.size()) +
                     " poses in " + fixed(t.duration(), 2) + " s";
  if (t.repeated_stamps > 0)
    line += " (" + std::to_string(t.repeated_stamps) + " with a repeated time left out)";
  return line + "\n";
}

std::string coverage_line(const Evaluation& e) {
  std::string line = "Coverage   ";
  if (e.frames)
    line += percent(e.frames->share()) + " of the frames (" + std::to_string(e.frames->with_pose) +
            " of " + std::to_string(e.frames->frames) + "), ";
  return line + percent(e.span.share) + " of the reference's " + fixed(e.reference.duration(), 2) +
         " s, longest gap " + fixed(e.span.longest_gap_s, 2) + " s\n";
}

std::string statistics_line(const std::string& label, const Statistics& s) {
  std::string line = padded(label, kLabelWidth);
  for (double value : {s.rmse, s.mean, s.median, s.standard_deviation, s.min, s.max})
    line += fixed(value, kDigits, kColumnWidth);
  return line;
}

std::string header_line() {
  std::string line(kLabelWidth, ' ');
  for (const std::string name : {"RMSE", "mean", "median", "S.D.", "min", "max"})
    line += std::string(kColumnWidth - name.size(), ' ') + name;
  return line + "\n" + std::string(line.size(), '-') + "\n";
}

nlohmann::ordered_json trajectory_json(const Trajectory& t) {
  return {{"file", t.name},
          {"poses", t.poses.size()},
          {"start_s", t.start()},
          {"end_s", t.end()},
          {"repeated_stamps", t.repeated_stamps}};
}

nlohmann::ordered_json relative_json(const Evaluation& e) {
  nlohmann::ordered_json json = {
      {"delta", e.options.delta.length},
      {"delta_unit", symbol_of(e.options.delta.unit)},
      {"pairs", e.relative ? e.relative->pairs : 0},
      {"pairs_of_another_interval", e.relative ? e.relative->of_another_interval : 0}};
  json["translation_m"] =
      e.relative ? statistics_json(e.relative->translation_m) : nlohmann::ordered_json();
  json["rotation_deg"] =
      e.relative ? statistics_json(e.relative->rotation_deg) : nlohmann::ordered_json();
  return json;
}

}  // namespace

nlohmann::ordered_json statistics_json(const Statistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"sd", s.standard_deviation},
          {"min", s.min},   {"max", s.max}};
}

std::string report_table(const Evaluation& e) {
  std::string text = file_line("Reference", e.reference) + file_line("Estimate", e.estimate);
  text += "Pairs      " + std::to_string(e.pairs.size()) + " of " +
          std::to_string(e.estimate.poses.size()) + " estimated poses have a reference within " +
          fixed(e.options.max_difference, 3) + " s\n" + coverage_line(e) + "\n" + header_line();
  text += statistics_line(padded("ATE, SE(3)", kUnitColumn) + "m", e.rigid.metres) + "\n";
  const std::string rotation = padded("ATE, SE(3), rotation", kUnitColumn) + "deg";
  text += e.rigid_rotation_deg ? statistics_line(rotation, *e.rigid_rotation_deg) + "\n"
                               : padded(rotation, kLabelWidth) +
                                     "  –: the path is too short or too straight for it\n";
  text += statistics_line(padded("ATE, Sim(3)", kUnitColumn) + "m", e.similarity.metres) +
          "   scale " + (e.scale ? fixed(*e.scale, 4) : "–: the path is too short for it") + "\n";
  const std::string delta = delta_text(e.options.delta);
  if (!e.relative) return text + "RPE over " + delta + ": the trajectories are too short\n";
  const std::string rpe = "RPE, " + delta;
  text +=
      statistics_line(padded(rpe + ", position", kUnitColumn) + "m", e.relative->translation_m) +
      "\n";
  text +=
      statistics_line(padded(rpe + ", rotation", kUnitColumn) + "deg", e.relative->rotation_deg) +
      "\n";
  if (const std::size_t others = e.relative->of_another_interval)
    text += "RPE: " + std::to_string(others) + " of " + std::to_string(e.relative->pairs) +
            " pairs are less than half of " + delta +
            " apart or more than one and a half times that, where poses are missing\n";
  return text;
}

nlohmann::ordered_json report_json(const Evaluation& e) {
  nlohmann::ordered_json json;
  json["reference"] = trajectory_json(e.reference);
  json["estimate"] = trajectory_json(e.estimate);
  json["max_difference_s"] = e.options.max_difference;
  json["offset_s"] = e.options.offset;
  json["pairs"] = e.pairs.size();
  json["coverage"] = {{"span", e.span.share}, {"longest_gap_s", e.span.longest_gap_s}};
  if (e.frames)
    json["coverage"].update({{"frames", e.frames->share()},
                             {"frame_count", e.frames->frames},
                             {"frames_with_pose", e.frames->with_pose}});
  json["ate"]["se3_m"] = statistics_json(e.rigid.metres);
  json["ate"]["se3_deg"] =
      e.rigid_rotation_deg ? statistics_json(*e.rigid_rotation_deg) : nlohmann::ordered_json();
  json["ate"]["sim3_m"] = statistics_json(e.similarity.metres);
  json["ate"]["sim3_scale"] = e.scale ? nlohmann::ordered_json(*e.scale) : nlohmann::ordered_json();
  json["rpe"] = relative_json(e);
  return json;
}

}  // namespace stillpoint::evaluation
