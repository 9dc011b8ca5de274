// A study with results of every kind.
#pragma once

#include <gtest/gtest.h>

#include "fixtures.hpp"
#include "study/study_results.hpp"

namespace stillpoint::study {

/// Two repeats of everything; one run has failed, one sequence was not covered, one has not run.
class Report : public ::testing::Test {
 protected:
  Report() {
    study_.baseline = "plain";
    results_.cells = cells_of(study_);
    CellResult failed;
    failed.exit_code = 3;
    failed.message = "cannot read 'a', \"b\"";
    results_.results = {
        result_with(0.5),  result_with(0.7),  result_with(0.06, 90.0), failed,
        result_with(0.01), result_with(0.02), result_with(0.02),       std::nullopt};
    results_.results[5]->origin.date = "2026-02-01";
    results_.command = "stillpoint ablate demo";
  }
  Study study_ = two_by_two(2);
  StudyResults results_{.study = study_, .cells = {}, .results = {}};
};

/// With all figures, of which others have published some.
class PublishedReport : public Report {
 protected:
  PublishedReport() {
    study_.question = "What for?";
    study_.sequences[0].original = "fr9_walking";
    study_.published = {{.name = "Other_SLAM",
                         .source = "Them & al., 2020",
                         .errors = {{"fr9_walking", {.ate_m = {0.25, 0.2, 0.15, 0.05}}}},
                         .times = {}}};
    study_.published[0].times.ms[1] = 9.375;
    for (auto& result : results_.results) {
      if (!result || result->failed()) continue;
      const double ate = *result->values[kAte];
      result->values[kAteMean] = ate / 2;
      result->values[kAteMedian] = ate / 4;
      result->values[kAteSd] = ate / 8;
      result->values[kFirstStage + 1] = 5.0;
    }
  }
};

}  // namespace stillpoint::study
