#include "output_web/truth.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "tum_recording/stamp_list.hpp"

namespace stillpoint::output_web {
namespace {

namespace fs = std::filesystem;

constexpr double kLargestGap = 0.1;  // seconds

Eigen::Matrix3Xd matrix_of(const std::vector<Eigen::Vector3d>& points) {
  return Eigen::Map<const Eigen::Matrix3Xd>(points.front().data(), 3,
                                            static_cast<Eigen::Index>(points.size()));
}

/// Time and position of a line.
std::optional<Eigen::Vector4d> parsed(const tum_recording::ListLine& line) {
  Eigen::Vector4d values;
  for (std::size_t i = 0; i < 4; ++i) {
    if (i >= line.columns.size()) return std::nullopt;
    const auto number = tum_recording::parse_number(line.columns[i]);
    if (!number) return std::nullopt;
    values[static_cast<Eigen::Index>(i)] = *number;
  }
  return values;
}

}  // namespace

Truth Truth::beside(const fs::path& recording) {
  const fs::path file = recording / "groundtruth.txt";
  std::error_code error;
  if (recording.empty() || !fs::is_regular_file(file, error)) return {};
  std::vector<Eigen::Vector4d> lines;
  for (const tum_recording::ListLine& line : tum_recording::read_list_lines(file))
    if (const auto values = parsed(line)) lines.push_back(*values);
  std::ranges::stable_sort(lines, {}, [](const Eigen::Vector4d& line) { return line[0]; });
  Truth truth;
  for (const Eigen::Vector4d& line : lines) {
    truth.times_.push_back(line[0]);
    truth.positions_.emplace_back(line.tail<3>());
  }
  return truth;
}

std::optional<Eigen::Vector3d> Truth::position_at(double seconds) const {
  const auto after = std::ranges::lower_bound(times_, seconds);
  if (after == times_.end()) return std::nullopt;
  const auto i = static_cast<std::size_t>(after - times_.begin());
  if (*after == seconds) return positions_[i];
  if (i == 0 || *after - times_[i - 1] > kLargestGap) return std::nullopt;
  const double share = (seconds - times_[i - 1]) / (*after - times_[i - 1]);
  return (1 - share) * positions_[i - 1] + share * positions_[i];
}

std::optional<TruthFit> fit_truth(const std::vector<Eigen::Vector3d>& truth,
                                  const std::vector<Eigen::Vector3d>& estimate) {
  if (truth.size() < 3) return std::nullopt;
  const Eigen::Matrix3Xd from = matrix_of(truth), to = matrix_of(estimate);
  TruthFit fit{.pairs = truth.size()};
  fit.world_from_truth = align_points(from, to, false).target_from_source;
  fit.rmse_m = std::sqrt(((fit.world_from_truth * from) - to).colwise().squaredNorm().mean());
  return fit;
}

}  // namespace stillpoint::output_web
