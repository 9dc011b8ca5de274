// What a run did, in a table for people.
#pragma once

#include <filesystem>
#include <ostream>
#include <string>

#include "stillpoint/support/run_statistics.hpp"

namespace stillpoint {

/// Collects the figures while the pipeline runs; they can be printed afterwards.
class RunTable final : public Output {
 public:
  void frame(const FrameReport& report) override { stages_.add(report.times); }
  void finish(const RunSummary& summary) override;

  void print(std::ostream& stream) const;
  /// False when the run was stopped or failed.
  bool complete() const { return complete_; }
  bool no_frames() const { return tracking_.frames == 0; }
  /// There were frames, and none of them has a pose.
  bool nothing_tracked() const { return !no_frames() && tracking_.tracked == 0; }

 private:
  void print_run(std::ostream& stream) const;
  void print_stages(std::ostream& stream) const;

  StageStatistics stages_;
  TrackingStatistics tracking_;
  SourceReport source_;
  std::size_t keyframes_ = 0;
  std::size_t landmarks_ = 0;
  bool complete_ = false;  // until it is finished
  int dropped_ = 0;
  int dropped_reports_ = 0;
  int loops_ = 0;
  int unlabelled_ = 0;
  int segmentation_failures_ = 0;
  std::string segmentation_failure_;
  double wall_seconds_ = 0.0;
  double cpu_seconds_ = 0.0;
  double recorded_seconds_ = 0.0;
  long long seed_ = 0;
  std::string mode_;
};

}  // namespace stillpoint
