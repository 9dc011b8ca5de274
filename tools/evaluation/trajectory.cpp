#include "evaluation/trajectory.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <optional>

#include "evaluation/statistics.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/atomic_file.hpp"
#include "stillpoint/support/tum_pose.hpp"

namespace stillpoint::evaluation {
namespace {

constexpr double kMinQuaternionNorm = 1e-3;  // shorter ones are placeholders, not rotations
constexpr double kMaxQuaternionNorm = 1e3;
constexpr double kFarthest = 1e7;  // metres; farther positions are no measurements
constexpr std::size_t kLongestLine = 1 << 16;
constexpr int kMostLines = 10'000'000;  // four days at 30 Hz
constexpr const char* kPoseFormat = "a line reads 'time tx ty tz qx qy qz qw'";
constexpr std::size_t kTumColumns = 8;
constexpr std::size_t kEurocColumns = 17;  // with velocity and biases
constexpr std::size_t kKittiColumns = 12;
constexpr double kKittiInterval = 0.1;           // seconds
constexpr double kFirstNanoseconds = 1e11;       // as seconds, in three thousand years
constexpr double kFirstWholeNanoseconds = 1e10;  // with commas; as seconds, in three hundred years
constexpr double kLongestStep = 1000.0;          // seconds between two poses
constexpr double kNanosecond = 1e-9;             // seconds
constexpr double kLeastOrthonormal = 1e-3;       // deviation of a rotation matrix

struct Line {
  std::string where;  // file:line
  std::vector<std::string> fields;
  bool has_commas = false;
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

/// Data lines, until `handle` gives false.
void for_each_line(const std::filesystem::path& file, const std::function<bool(Line)>& handle) {
  if (!std::filesystem::exists(file))
    throw Error(Fault::kData, "no such file", file.string(), "check the path");
  if (!std::filesystem::is_regular_file(file))
    throw Error(Fault::kData, "is a folder, a device or a pipe, and no file", file.string(),
                "write it into a file first");
  std::ifstream stream(file);
  if (!stream) throw Error(Fault::kData, "cannot be read", file.string());
  std::string text(kLongestLine, '\0');
  for (int number = 1; stream.getline(text.data(), kLongestLine); ++number) {
    const std::string where = file.string() + ":" + std::to_string(number);
    if (number > kMostLines) throw Error(Fault::kData, "too many lines for a trajectory", where);
    std::vector<std::string> fields = split(text.c_str());
    if (fields.empty() || fields.front().front() == '#') continue;
    if (!handle({where, std::move(fields), text.find(',') < std::strlen(text.c_str())})) return;
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

std::vector<double> parse_numbers(const Line& line) {
  std::vector<double> numbers;
  numbers.reserve(line.fields.size());
  for (const std::string& field : line.fields) numbers.push_back(parse_number(field, line.where));
  return numbers;
}

bool is_whole_with_commas(const Line& line) {
  return line.has_commas && line.fields[0].find_first_of(".eE") == std::string::npos;
}

/// By the first two lines: by what they hold, by their times, or by the step between them, which
/// would be longer than any camera waits.
bool is_in_nanoseconds(const std::filesystem::path& file) {
  bool nanoseconds = false;
  std::optional<double> first;
  for_each_line(file, [&](const Line& line) {
    const double time = parse_number(line.fields.front(), line.where);
    nanoseconds = line.fields.size() == kEurocColumns || std::abs(time) > kFirstNanoseconds ||
                  (is_whole_with_commas(line) && time > kFirstWholeNanoseconds);
    if (first && is_whole_with_commas(line)) nanoseconds |= time - *first > kLongestStep;
    const bool is_known = nanoseconds || first;
    first = time;
    return !is_known;
  });
  return nanoseconds;
}

StampedPose pose_with_quaternion(const std::vector<double>& v, const Line& line, bool nanoseconds) {
  const bool w_first = nanoseconds && line.has_commas;
  const Eigen::Quaterniond rotation = w_first ? Eigen::Quaterniond(v[4], v[5], v[6], v[7])
                                              : Eigen::Quaterniond(v[7], v[4], v[5], v[6]);
  if (rotation.norm() < kMinQuaternionNorm)
    throw Error(Fault::kData, "the quaternion has length 0", line.where, kPoseFormat);
  if (rotation.norm() > kMaxQuaternionNorm)
    throw Error(Fault::kData, "the quaternion has not length 1", line.where, kPoseFormat);
  StampedPose pose{nanoseconds ? kNanosecond * v[0] : v[0], Pose::Identity()};
  pose.world_from_camera.linear() = rotation.normalized().toRotationMatrix();
  pose.world_from_camera.translation() = Eigen::Vector3d(v[1], v[2], v[3]);
  return pose;
}

StampedPose pose_of_matrix(const std::vector<double>& v, int index, const Line& line) {
  StampedPose pose{kKittiInterval * index, Pose::Identity()};
  pose.world_from_camera.affine() =
      Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>>(v.data());
  const Eigen::Matrix3d rotation = pose.world_from_camera.linear();
  if (!(rotation * rotation.transpose()).isIdentity(kLeastOrthonormal) ||
      rotation.determinant() < 0)
    throw Error(Fault::kData, "these 12 numbers are no pose: the left 3 x 3 of them no rotation",
                line.where, "a line of the KITTI format holds the rows of a 3 x 4 matrix");
  pose.world_from_camera = orthonormalised(pose.world_from_camera);
  return pose;
}

/// `index` of the pose in its file.
StampedPose parse_pose(const Line& line, int index, bool nanoseconds) {
  const std::size_t columns = line.fields.size();
  if (columns != kTumColumns && columns != kKittiColumns && columns != kEurocColumns)
    throw Error(Fault::kData, "expected 8 columns, found " + std::to_string(columns), line.where,
                kPoseFormat);
  const std::vector<double> numbers = parse_numbers(line);
  StampedPose pose = columns == kKittiColumns ? pose_of_matrix(numbers, index, line)
                                              : pose_with_quaternion(numbers, line, nanoseconds);
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
  std::size_t columns = 0;
  const bool nanoseconds = is_in_nanoseconds(file);
  for_each_line(file, [&](const Line& line) {
    const StampedPose pose = parse_pose(line, static_cast<int>(poses.size()), nanoseconds);
    if (columns == 0) columns = line.fields.size();
    if (line.fields.size() != columns)
      throw Error(Fault::kData,
                  "expected " + std::to_string(columns) +
                      " columns, as in the lines before, found " +
                      std::to_string(line.fields.size()),
                  line.where);
    if (!poses.empty()) check_order(trajectory.end(), pose.time, line.where);
    if (!poses.empty() && trajectory.end() == pose.time) {
      poses.pop_back();
      ++trajectory.repeated_stamps;
    }
    poses.push_back(pose);
    return true;
  });
  check_not_empty(poses.empty(), file, kPoseFormat);
  trajectory.has_times = columns != kKittiColumns;
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

void write_trajectory(const std::filesystem::path& file, const std::vector<StampedPose>& poses) {
  AtomicFile written(file);
  for (const StampedPose& pose : poses)
    write_tum_pose(written.stream(), pose.time, pose.world_from_camera);
  written.commit();
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
    return true;
  });
  check_not_empty(stamps.empty(), file, "a line begins with a time in seconds");
  return stamps;
}

}  // namespace stillpoint::evaluation
