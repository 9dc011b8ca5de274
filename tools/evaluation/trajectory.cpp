#include "evaluation/trajectory.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>

#include "evaluation/statistics.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr double kMinQuaternionNorm = 1e-3;  // shorter ones are placeholders, not rotations
constexpr double kFarthest = 1e7;            // metres; farther positions are no measurements
constexpr std::size_t kLongestLine = 1 << 16;
constexpr int kMostLines = 10'000'000;  // four days at 30 Hz
constexpr const char* kPoseFormat = "a line reads 'time tx ty tz qx qy qz qw'";

struct Line {
  std::string where;  // file:line
  std::vector<std::string> fields;
};

// The benchmark's scripts take commas and tabs for blanks, too.
std::vector<std::string> split(const std::string& line) {
  constexpr const char* kSeparators = " ,\t\r";
  std::vector<std::string> fields;
  for (std::size_t begin = line.find_first_not_of(kSeparators); begin != std::string::npos;) {
    const std::size_t end = std::min(line.find_first_of(kSeparators, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kSeparators, end);
  }
  return fields;
}

void for_each_line(const std::filesystem::path& file, const std::function<void(Line)>& handle) {
  if (!std::filesystem::exists(file))
    throw Error(Fault::kData, "no such file", file.string(), "check the path");
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file))
    throw Error(Fault::kData, "cannot be read as a file", file.string());
  std::string text(kLongestLine, '\0');
  for (int number = 1; stream.getline(text.data(), kLongestLine); ++number) {
    const std::string where = file.string() + ":" + std::to_string(number);
    if (number > kMostLines) throw Error(Fault::kData, "too many lines for a trajectory", where);
    std::vector<std::string> fields = split(text.c_str());
    if (fields.empty() || fields.front().front() == '#') continue;
    handle({where, std::move(fields)});
  }
  if (!stream.eof())
    throw Error(Fault::kData, "a line is too long, or cannot be read", file.string(), kPoseFormat);
}

double parse_number(const std::string& field, const std::string& where) {
  double value = 0;
  const char* end = field.data() + field.size();
  const auto [rest, fault] = std::from_chars(field.data(), end, value);
  if (fault != std::errc() || rest != end)
    throw Error(Fault::kData, "'" + field + "' is not a number", where);
  if (!std::isfinite(value))
    throw Error(Fault::kData, "'" + field + "' is not a finite number", where,
                "leave out poses that are not known");
  return value;
}

StampedPose parse_pose(const Line& line) {
  if (line.fields.size() != 8)
    throw Error(Fault::kData, "expected 8 columns, found " + std::to_string(line.fields.size()),
                line.where, kPoseFormat);
  double v[8];
  for (int i = 0; i < 8; ++i) v[i] = parse_number(line.fields[i], line.where);
  const Eigen::Quaterniond rotation(v[7], v[4], v[5], v[6]);
  if (rotation.norm() < kMinQuaternionNorm)
    throw Error(Fault::kData, "the quaternion has length 0", line.where, kPoseFormat);
  StampedPose pose{v[0], Pose::Identity()};
  pose.world_from_camera.linear() = rotation.normalized().toRotationMatrix();
  pose.world_from_camera.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
  if (pose.world_from_camera.translation().norm() > kFarthest)
    throw Error(Fault::kData, "the position is more than 10,000 km away", line.where,
                "positions are in metres");
  return pose;
}

void check_order(double previous, double time, const std::string& where) {
  if (time < previous)
    throw Error(Fault::kData, "the time is earlier than that of the line before", where,
                "sort the lines by time");
}

void check_not_empty(bool empty, const std::filesystem::path& file, const char* format) {
  if (empty) throw Error(Fault::kData, "the file holds no data line", file.string(), format);
}

}  // namespace

Trajectory read_trajectory(const std::filesystem::path& file) {
  Trajectory trajectory{file.string(), {}, 0};
  std::vector<StampedPose>& poses = trajectory.poses;
  for_each_line(file, [&](const Line& line) {
    const StampedPose pose = parse_pose(line);
    if (!poses.empty()) check_order(trajectory.end(), pose.time, line.where);
    if (!poses.empty() && trajectory.end() == pose.time) {
      poses.pop_back();
      ++trajectory.repeated_stamps;
    }
    poses.push_back(pose);
  });
  check_not_empty(poses.empty(), file, kPoseFormat);
  return trajectory;
}

Pose pose_at(const Trajectory& trajectory, double time) {
  if (trajectory.poses.size() == 1) return trajectory.poses.front().world_from_camera;
  std::size_t i = 1;
  while (i + 1 < trajectory.poses.size() && trajectory.poses[i].time < time) ++i;
  const auto& [before, a] = trajectory.poses[i - 1];
  const auto& [after, b] = trajectory.poses[i];
  return interpolate(a, b, std::clamp((time - before) / (after - before), 0.0, 1.0));
}

std::vector<double> times_of(const Trajectory& trajectory) {
  std::vector<double> times;
  for (const StampedPose& pose : trajectory.poses) times.push_back(pose.time);
  return times;
}

double median_interval(const Trajectory& trajectory) {
  std::vector<double> intervals;
  for (std::size_t i = 1; i < trajectory.poses.size(); ++i)
    intervals.push_back(trajectory.poses[i].time - trajectory.poses[i - 1].time);
  return statistics_of(std::move(intervals)).median;
}

std::vector<double> read_stamps(const std::filesystem::path& file) {
  std::vector<double> stamps;
  for_each_line(file, [&](const Line& line) {
    const double time = parse_number(line.fields.front(), line.where);
    if (!stamps.empty()) check_order(stamps.back(), time, line.where);
    stamps.push_back(time);
  });
  check_not_empty(stamps.empty(), file, "a line begins with a time in seconds");
  return stamps;
}

}  // namespace stillpoint::evaluation
