// The true trajectory beside the estimated one, where the recording has it.
#pragma once

#include <filesystem>
#include <optional>
#include <stillpoint/sdk.hpp>
#include <vector>

namespace stillpoint::output_web {

class Truth {
 public:
  /// None.
  Truth() = default;
  /// `groundtruth.txt` of a recording in TUM's format: time tx ty tz …. Lines that are no poses are
  /// left out; without a file, there is no truth.
  static Truth beside(const std::filesystem::path& recording);
  /// Seconds and metres, in order of time.
  Truth(std::vector<double> times, std::vector<Eigen::Vector3d> positions)
      : times_(std::move(times)), positions_(std::move(positions)) {}

  bool known() const { return !times_.empty(); }
  /// Between the neighbours in time; nothing where these are farther than 0.1 s apart.
  std::optional<Eigen::Vector3d> position_at(double seconds) const;

 private:
  std::vector<double> times_;
  std::vector<Eigen::Vector3d> positions_;
};

/// What puts the truth beside an estimate: the rigid motion with the least squares of distances
/// (Umeyama, PAMI 1991), and their root mean square.
struct TruthFit {
  Pose world_from_truth = Pose::Identity();
  double rmse_m = 0.0;
  std::size_t pairs = 0;
};

/// Nothing with fewer than three pairs.
std::optional<TruthFit> fit_truth(const std::vector<Eigen::Vector3d>& truth,
                                  const std::vector<Eigen::Vector3d>& estimate);

}  // namespace stillpoint::output_web
