#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report_fixture.hpp"
#include "study/csv_report.hpp"
#include "study/latex_report.hpp"
#include "study/markdown_report.hpp"
#include "study/markdown_table.hpp"
#include "study/table_cells.hpp"

namespace stillpoint::study {
namespace {

TEST(Spread, IsMedianAndExtremes) {
  EXPECT_FALSE(spread_of({}));
  const auto odd = spread_of({3, 1, 2});
  EXPECT_EQ(odd->median, 2);
  EXPECT_EQ(odd->min, 1);
  EXPECT_EQ(odd->max, 3);
  EXPECT_EQ(odd->count, 3u);
  EXPECT_EQ(spread_of({4, 1, 2, 10})->median, 3);
}

TEST(MarkdownTable, HasColumnsOfEqualWidth) {
  EXPECT_EQ(markdown_table({"a", "b"}, {{"1–2", "x|y"}, {"12345", ""}}),
            "| a     | b    |\n"
            "|-------|------|\n"
            "| 1–2   | x\\|y |\n"
            "| 12345 |      |\n");
}

// Of the columns for mean, median and S.D. of the errors, and for stages.
const std::string kNoDetails(kMetricCount - kAteMean, ',');

TEST_F(Report, AsMarkdown) {
  EXPECT_EQ(
      markdown_report(results_, "demo"),
      "# demo\n"
      "\n"
      "Median (smallest–largest) of 2 runs, seeds 7 to 8. Coverage is given after an error "
      "where it is below 100 %.\n"
      "\n"
      "**Not finished:** 1 of 8 runs are missing.\n"
      "\n"
      "`stillpoint ablate demo`\n"
      "\n"
      "* 6 of 7 runs: Stillpoint 1.2.3, commit 0123456789ab; a machine, 2 cores; 2026-01-30 to "
      "2026-02-01\n"
      "* 1 of 7 runs: a build that has left no record\n"
      "\n"
      "## Absolute trajectory error, SE(3), RMSE (m)\n"
      "\n"
      "| sequence      | plain                  | better                           |\n"
      "|---------------|------------------------|----------------------------------|\n"
      "| walking       | 0.6000 (0.5000–0.7000) | 0.0600, coverage 90.0 % [1 of 2] |\n"
      "| walking_empty | 0.0150 (0.0100–0.0200) | 0.0200 [1 of 2]                  |\n"
      "\n"
      "## Compared with plain, recording by recording\n"
      "\n"
      "| variant | recordings | better | worse | by loss or coverage | ATE ratio | CPU ratio | "
      "effect | p      | corrected p              |\n"
      "|---------|------------|--------|-------|---------------------|-----------|-----------|"
      "--------|--------|--------------------------|\n"
      "| better  | 1          | 0      | 1     | 1                   | –         | –         | "
      "-1.00 "
      " | "
      "1.0000 | 1.0000 (at least 1.0000) |\n"
      "\n"
      "Ratios: median (quartiles); below 1 the variant has the smaller error, or takes less "
      "time. By loss or coverage: recordings on which one of the two failed, lost tracking or "
      "covered less, and so is the worse one. Effect: 1, the variant is always better; -1, always "
      "worse. p: Wilcoxon's signed-rank test of the ATE, two-sided; corrected for the number of "
      "variants after Holm. Empty scenes, which the dynamic penalty is measured with, "
      "take no part. At least: the smallest p that so few recordings can give, however large the "
      "difference; with 1 comparison, it takes 6 recordings to come below 0.05.\n"
      "\n"
      "## Improvement of the ATE over plain (%)\n"
      "\n"
      "| sequence      | plain | better                         |\n"
      "|---------------|-------|--------------------------------|\n"
      "| walking       | –     | 88.0, coverage 90.0 % [1 of 2] |\n"
      "| walking_empty | –     | -100.0 [1 of 2]                |\n"
      "\n"
      "1 − ATE ÷ ATE of plain, run by run with the same seed: median (smallest–largest).\n"
      "\n"
      "## Dynamic penalty: ATE ÷ ATE along the same camera path in the empty scene\n"
      "\n"
      "| sequence | plain | better                         |\n"
      "|----------|-------|--------------------------------|\n"
      "| walking  | 40.00 | 3.00, coverage 90.0 % [1 of 2] |\n"
      "\n"
      "## Coverage: frames with a pose (%)\n"
      "\n"
      "| sequence      | plain               | better         |\n"
      "|---------------|---------------------|----------------|\n"
      "| walking       | 100.0 (100.0–100.0) | 90.0 [1 of 2]  |\n"
      "| walking_empty | 100.0 (100.0–100.0) | 100.0 [1 of 2] |\n"
      "\n"
      "## Times tracking was lost\n"
      "\n"
      "0 in every run.\n"
      "\n"
      "## Variants\n"
      "\n"
      "| variant | pipeline     | changes               |\n"
      "|---------|--------------|-----------------------|\n"
      "| plain   | orb_baseline |                       |\n"
      "| better  | orb_baseline | tracker.features=2000 |\n"
      "\n"
      "## Runs that failed or cannot be compared\n"
      "\n"
      "* walking/better/1: exit code 3: cannot read 'a', \"b\"\n");
}

TEST_F(Report, AsCsv) {
  results_.cells = {results_.cells[0], results_.cells[3], results_.cells[7]};
  results_.results = {results_.results[0], results_.results[3], results_.results[7]};
  EXPECT_EQ(
      csv_report(results_),
      "sequence,variant,repeat,seed,state,exit_code,ate_m,sim3_scale,rpe_translation_m,"
      "rpe_rotation_deg,coverage_percent,times_lost,dropped_frames,frames_per_second,track_p50_ms,"
      "track_p95_ms,cpu_ms_per_frame,peak_memory_mib,"
      "ate_mean_m,ate_median_m,ate_sd_m,rpe_translation_mean_m,"
      "rpe_translation_median_m,rpe_translation_sd_m,rpe_rotation_mean_deg,"
      "rpe_rotation_median_deg,rpe_rotation_sd_deg,source_ms,prepare_ms,"
      "moving_check_ms,map_check_ms,segmentation_wait_ms,segmentation_ms,propagate_ms,"
      "beside_wait_ms,decision_ms,track_ms,track_thread_ms,outputs_ms,map_insert_ms,"
      "map_refine_ms,map_correct_ms,loop_ms,loop_adjust_ms,dense_ms,"
      "seconds,version,commit,machine,date,message,command\n"
      "walking,plain,0,7,done,0,0.5,,,,100,0,,,,,,," +
          kNoDetails +
          "2.5,1.2.3,0123456789ab,"
          "\"a machine, 2 cores\",2026-01-30,,stillpoint ablate demo\n"
          "walking,better,1,8,failed,3,,,,,,,,,,,,," +
          kNoDetails +
          "0,,,,,\"cannot read 'a', \"\"b\"\"\",stillpoint ablate demo\n"
          "walking_empty,better,1,8,missing,,,,,,,,,,,,,," +
          kNoDetails + ",,,,,,stillpoint ablate demo\n");
}

TEST_F(Report, AVariantOfAStudyWithOneSequenceIsARow) {
  study_.sequences.pop_back();
  results_.cells.resize(4);
  results_.results.resize(4);
  EXPECT_THAT(markdown_report(results_, "demo"),
              ::testing::HasSubstr(
                  "\n## Overview\n\n"
                  "| variant | ATE (m)                          | coverage (%)        |\n"
                  "|---------|----------------------------------|---------------------|\n"
                  "| plain   | 0.6000 (0.5000–0.7000)           | 100.0 (100.0–100.0) |\n"
                  "| better  | 0.0600, coverage 90.0 % [1 of 2] | 90.0 [1 of 2]       |\n"));
}

TEST_F(PublishedReport, AsMarkdown) {
  const std::string report = markdown_report(results_, "demo");
  EXPECT_THAT(report, ::testing::StartsWith("# demo\n\nWhat for?\n\nMedian (smallest"));
  EXPECT_THAT(report,
              ::testing::HasSubstr(
                  "| sequence      | plain                  | better                           | "
                  "Other_SLAM (published) |\n"
                  "|---------------|------------------------|----------------------------------|-"
                  "-----------------------|\n"
                  "| walking       | 0.6000 (0.5000–0.7000) | 0.0600, coverage 90.0 % [1 of 2] | "
                  "0.2500                 |\n"
                  "| walking_empty | 0.0150 (0.0100–0.0200) | 0.0200 [1 of 2]                  | "
                  "–                      |\n"
                  "\n"
                  "Published, not measured here: Other_SLAM (Them & al., 2020).\n"));
  EXPECT_THAT(report, ::testing::HasSubstr(
                          "## Time of each stage, mean of its calls (ms)\n"
                          "\n"
                          "| stage                        | plain            | better           | "
                          "Other_SLAM (published) |\n"
                          "|------------------------------|------------------|------------------|-"
                          "-----------------------|\n"
                          "| Feature extraction (prepare) | 5.00 (5.00–5.00) | 5.00 (5.00–5.00) | "
                          "9.38                   |\n"));
  EXPECT_THAT(report, ::testing::ContainsRegex("walking +\\| plain +\\| 0.6000 +\\| 0.3000 +\\| "
                                               "0.1500 +\\| 0.0750 +\\| – "));
  EXPECT_THAT(report, ::testing::ContainsRegex("walking +\\| Other_SLAM \\(published\\) +\\| "
                                               "0.2500 +\\| 0.2000 +\\| 0.1500 +\\| 0.0500 "));
}

TEST_F(PublishedReport, FiguresOfARecordingOnWhichNothingRanAreNotShown) {
  study_.published[0].times = {};
  for (std::size_t run = 0; run < 4; ++run) results_.results[run].reset();
  const std::string report = markdown_report(results_, "demo");
  EXPECT_THAT(report, ::testing::HasSubstr("\n| walking_empty | plain   | 0.0150"));
  EXPECT_THAT(report, ::testing::Not(::testing::HasSubstr("Other_SLAM")));
  EXPECT_THAT(report, ::testing::Not(::testing::HasSubstr("Published")));
}

// A median of the coverage would hide the run that was lost half of the time.
TEST_F(Report, TheCoverageOfAllRunsIsSaid) {
  Study study = two_by_two(3);
  study.sequences.resize(1);
  StudyResults results{.study = study, .cells = cells_of(study), .results = {}, .command = ""};
  for (const double coverage : {100.0, 100.0, 100.0, 100.0, 40.0, 100.0})
    results.results.emplace_back(result_with(0.1, coverage));
  EXPECT_EQ(coverage_note(results, 0, 0), "");
  EXPECT_EQ(coverage_note(results, 0, 1), ", coverage 40.0–100.0 %");
  EXPECT_THAT(latex_report(results, "demo"), ::testing::HasSubstr("[40.0--100.0\\,\\%]"));
}

TEST_F(PublishedReport, WhatIsIncompleteIsSaidInEveryTableOfErrors) {
  results_.results[2] = results_.results[3];  // both runs of `better` have failed
  const std::string report = markdown_report(results_, "demo");
  EXPECT_THAT(report, ::testing::ContainsRegex("walking +\\| better +\\| failed +\\| – "));
  EXPECT_THAT(report,
              ::testing::ContainsRegex("walking_empty +\\| better +\\| 0.0200 \\[1 of 2\\]"));
  EXPECT_THAT(latex_report(results_, "demo"),
              ::testing::HasSubstr("better & -- {\\scriptsize [failed]} & -- & -- & --"));
  EXPECT_THAT(csv_summary(results_), ::testing::HasSubstr("walking,better,ate_m,0,2,0,,,,,,"));
}

TEST_F(Report, TheCoverageOfTheBaselineIsSaidBesideAnImprovementOverIt) {
  for (const std::size_t run : {0, 1}) results_.results[run]->values[kCoverage] = 40.0;
  EXPECT_THAT(markdown_report(results_, "demo"),
              ::testing::HasSubstr("88.0, coverage 90.0 %, baseline 40.0 % [1 of 2]"));
  EXPECT_THAT(latex_report(results_, "demo"), ::testing::HasSubstr("[baseline 40.0\\,\\%]"));
}

TEST_F(Report, TheBestOfASequenceCoversAsMuchAsTheOthers) {
  using ::testing::ElementsAre;
  EXPECT_THAT(best_variants(results_, 0, kAte), ElementsAre(false, false));
  EXPECT_THAT(best_variants(results_, 0, kCoverage), ElementsAre(true, false));
  EXPECT_THAT(best_variants(results_, 1, kAte), ElementsAre(true, false));
  results_.results[6]->values[kAte] = 0.01501;  // 0.0150, as the other
  EXPECT_THAT(best_variants(results_, 1, kAte), ElementsAre(false, false));
}

TEST_F(Report, TheBestOfASequenceFailsAndGetsLostAsRarelyAsTheOthers) {
  using ::testing::ElementsAre;
  Study study = two_by_two(3);
  study.sequences.resize(1);
  StudyResults results{.study = study, .cells = cells_of(study), .results = {}, .command = ""};
  for (const double ate : {0.3, 0.3, 0.3, 0.1, 0.1, 0.1})
    results.results.emplace_back(result_with(ate));
  EXPECT_THAT(best_variants(results, 0, kAte), ElementsAre(false, true));
  results.results[4]->values[kTimesLost] = 1.0;
  EXPECT_THAT(best_variants(results, 0, kAte), ElementsAre(false, false));
  results.results[0]->values[kTimesLost] = 2.0;  // so was the other, as often
  EXPECT_THAT(best_variants(results, 0, kAte), ElementsAre(false, true));
  results.results[0]->values[kCoverage] = results.results[1]->values[kCoverage] = 50.0;
  EXPECT_THAT(best_variants(results, 0, kAte), ElementsAre(false, false)) << "covers less";
  results.results[0]->values[kCoverage] = results.results[1]->values[kCoverage] = 100.0;
  results.results[5] = CellResult{};
  results.results[5]->exit_code = 1;
  EXPECT_THAT(best_variants(results, 0, kAte), ElementsAre(false, false));
}

TEST(Published, IsFoundByRecordingAndFigure) {
  Published system;
  system.errors["r"].rpe_rotation_deg = {4, 3, 2, 1};
  system.errors["r"].ate_m = {0.5};
  EXPECT_EQ(system.find("r", kRpeRotation), 4);
  EXPECT_EQ(system.find("r", kRpeRotationSd), 1);
  EXPECT_EQ(system.find("r", kAte), 0.5);
  EXPECT_EQ(system.find("r", kAteMean), std::nullopt);
  EXPECT_EQ(system.find("r", kRpeTranslation), std::nullopt);
  EXPECT_EQ(system.find("r", kCoverage), std::nullopt);
  EXPECT_EQ(system.find("s", kAte), std::nullopt);
  EXPECT_EQ(system.find("r", kFirstStage), std::nullopt);
  system.times.ms[0] = 7;
  EXPECT_EQ(system.find("r", kFirstStage), 7);
}

TEST_F(Report, AsSummary) {
  const std::string origin =
      ",\"stillpoint ablate demo | 6 of 7 runs: Stillpoint 1.2.3, commit 0123456789ab; a machine, "
      "2 cores; 2026-01-30 to "
      "2026-02-01 | 1 of 7 runs: a build that has left no record\"\n";
  EXPECT_THAT(
      csv_summary(results_),
      ::testing::StartsWith("sequence,variant,metric,runs,failed,missing,median,first_quartile,"
                            "third_quartile,smallest,largest,study_origin\n"
                            "walking,plain,ate_m,2,0,0,0.6,0.55,0.65,0.5,0.7" +
                            origin + "walking,plain,coverage_percent,2,0,0,100,100,100,100,100" +
                            origin + "walking,plain,times_lost,2,0,0,0,0,0,0,0" + origin +
                            "walking,better,ate_m,1,1,0,0.06,0.06,0.06,0.06,0.06" + origin));
  EXPECT_THAT(csv_summary(results_), ::testing::HasSubstr("walking_empty,better,ate_m,1,0,1,0.02"));
}

TEST_F(Report, ASequenceWithoutTwinHasNoPenalty) {
  EXPECT_FALSE(dynamic_penalty(results_, 1, 0));
  EXPECT_NEAR(*dynamic_penalty(results_, 0, 0), 40.0, 1e-9);
}

}  // namespace
}  // namespace stillpoint::study
