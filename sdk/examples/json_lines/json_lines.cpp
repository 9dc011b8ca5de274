#include "json_lines.hpp"

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>

using Json = nlohmann::ordered_json;
using stillpoint::FrameReport;
using stillpoint::TrackState;

namespace {

/// To a millionth: what is smaller is noise, and makes lines long.
double rounded(double value) { return std::round(1e6 * value) / 1e6; }

template <class Vector>
Json array_of(const Vector& vector) {
  Json json = Json::array();
  for (const double value : vector) json.push_back(rounded(value));
  return json;
}

Json objects_of(const FrameReport& report, const stillpoint::ClassNames& classes) {
  Json objects = Json::array();
  if (!report.segmentation) return objects;
  for (std::size_t i = 0; i < report.segmentation->objects.size(); ++i) {
    const stillpoint::SegmentedObject& object = report.segmentation->objects[i];
    const bool decided = report.weights && i < report.weights->object_moves.size();
    const cv::Rect& box = object.box;
    objects.push_back(
        {{"class", classes.at(static_cast<std::size_t>(object.label))},
         {"id", object.id < 0 ? Json() : Json(object.id)},
         {"box", {box.x, box.y, box.width, box.height}},
         {"moves", decided ? Json(report.weights->object_moves[i] == true) : Json()}});
  }
  return objects;
}

/// Of the pixels that tracking may use.
double static_share(const FrameReport& report) {
  if (!report.weights || report.weights->track.empty()) return 1.0;
  return cv::mean(report.weights->track)[0] / 255;
}

Json times_of(const FrameReport& report) {
  Json milliseconds = Json::object();
  for (const stillpoint::StageTime& time : report.times)
    if (time.frame == report.frame->index) milliseconds[time.stage] = rounded(time.wall_ms);
  return milliseconds;
}

/// What is not known is null.
Json object_of(const FrameReport& report, const stillpoint::ClassNames& classes) {
  const stillpoint::TrackResult& result = report.result;
  const bool tracked = result.state == TrackState::kTracking;
  const Eigen::Quaterniond orientation(result.world_from_camera.linear());
  const auto moving = std::ranges::count_if(report.moving.points, &stillpoint::PointMotion::moving);
  return {{"frame", report.frame->index},
          {"time", rounded(report.frame->time)},
          {"state", stillpoint::name_of(result.state)},
          {"position", tracked ? array_of(result.world_from_camera.translation()) : Json()},
          {"orientation", tracked ? array_of(orientation.coeffs()) : Json()},
          {"keyframe", result.keyframe ? Json(result.keyframe->id) : Json()},
          {"matches", result.matches},
          {"inliers", result.inliers},
          {"moving_points", report.moving.reliable ? Json(moving) : Json()},
          {"static_share", rounded(static_share(report))},
          {"objects", objects_of(report, classes)},
          {"ms", times_of(report)}};
}

[[noreturn]] void fail(const std::string& name) {
  throw stillpoint::Error(stillpoint::Fault::kUsage,
                          std::string("cannot write: ") + std::strerror(errno), name);
}

}  // namespace

JsonLines::JsonLines(const Options& options, const stillpoint::StageContext& context)
    : name_(options.file == "-" ? "standard output"
                                : (context.output_directory / options.file).string()),
      classes_(context.classes),
      log_(context.log),
      to_standard_output_(options.file == "-") {}

void JsonLines::frame(const FrameReport& report) {
  if (!opened_) open();
  if (!file_) return;
  // Class names may come from anywhere and need not be valid UTF-8.
  const std::string line =
      object_of(report, classes_).dump(-1, ' ', false, Json::error_handler_t::replace) + '\n';
  errno = 0;
  if (std::fputs(line.c_str(), file_.get()) >= 0 && std::fflush(file_.get()) == 0) return;
  // `head` goes when it has enough. The run goes on: the program ignores SIGPIPE.
  if (errno != EPIPE) fail(name_);
  log_(stillpoint::LogLevel::kInfo, name_ + " is closed: no more lines are written");
  file_.reset();
}

/// Not in the constructor: a run without a frame leaves the file of an earlier one.
void JsonLines::open() {
  file_.reset(to_standard_output_ ? stdout : std::fopen(name_.c_str(), "w"));
  if (!file_) fail(name_);
  opened_ = true;
}

STILLPOINT_PLUGIN(json_lines, "0.1.0",
                  stillpoint::provide<stillpoint::Output, JsonLines>(
                      "json_lines", "one JSON object per frame, to a file or standard output"));
