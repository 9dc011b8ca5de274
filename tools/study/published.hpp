// Figures that others have published, to be shown beside those of a study.
#pragma once

#include <array>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "stillpoint/options.hpp"
#include "study/metrics.hpp"

namespace stillpoint::study {

/// Of one recording; each either empty, or the RMSE, or RMSE, mean, median and S.D.
struct PublishedErrors {
  std::vector<double> ate_m, rpe_translation_m, rpe_rotation_deg;

  void visit(OptionVisitor& visitor);
};

/// Milliseconds per call of each stage; 0: not published.
struct PublishedTimes {
  std::array<double, kMetricCount - kFirstStage> ms{};

  void visit(OptionVisitor& visitor);
};

struct Published {
  std::string name;                               ///< of the system
  std::string source;                             ///< where the figures are found
  std::map<std::string, PublishedErrors> errors;  ///< by recording, see Sequence::original
  PublishedTimes times;

  void visit(OptionVisitor& visitor);

  /// Of a recording, except for times of stages, which are of all; nothing: not published.
  std::optional<double> find(const std::string& recording, MetricId metric) const;
};

}  // namespace stillpoint::study
