#include "study/latex_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "report_fixture.hpp"
#include "support/latex.hpp"

namespace stillpoint::study {
namespace {

TEST_F(PublishedReport, AsLatex) {
  const std::string tables = latex_report(results_, "demo");
  EXPECT_THAT(
      tables,
      ::testing::StartsWith(
          "% Needs \\usepackage{booktabs}. Tables of the study demo.\n"
          "% stillpoint ablate demo\n"
          "% 6 of 7 runs: Stillpoint 1.2.3, commit 0123456789ab; a machine, 2 cores; 2026-01-30 to "
          "2026-02-01\n"));
  // The better one covers too little to be the best of its sequence.
  EXPECT_THAT(tables,
              ::testing::HasSubstr(
                  "    Sequence & plain & better & \\textit{Other\\_SLAM} \\\\\n"
                  "    \\midrule\n"
                  "    walking & 0.6000 {\\scriptsize (0.5000--0.7000)} & 0.0600 {\\scriptsize "
                  "[90.0\\,\\%, 1 of 2]} & \\textit{0.2500} \\\\\n"
                  "    walking\\_empty & \\textbf{0.0150} {\\scriptsize (0.0100--0.0200)} & 0.0200 "
                  "{\\scriptsize [1 of 2]} & -- \\\\\n"
                  "    \\bottomrule\n"));
  EXPECT_THAT(tables, ::testing::HasSubstr("Not finished: 1 of 8 runs are missing."));
  EXPECT_THAT(tables, ::testing::HasSubstr("Other\\_SLAM: Them \\& al., 2020."));
  EXPECT_THAT(tables, ::testing::HasSubstr(
                          "    Sequence & System & RMSE & Mean & Median & S.D. \\\\\n"
                          "    \\midrule\n"
                          "    walking & plain & 0.6000 & 0.3000 & 0.1500 & 0.0750 \\\\\n"
                          "     & better & 0.0600 {\\scriptsize [90.0\\,\\%, 1 of 2]} & "
                          "0.0300 & 0.0150 & 0.0075 \\\\\n"
                          "     & \\textit{Other\\_SLAM} & \\textit{0.2500} & \\textit{0.2000} & "
                          "\\textit{0.1500} & \\textit{0.0500} \\\\\n"
                          "    \\addlinespace\n"
                          "    walking\\_empty & plain & \\textbf{0.0150} & "));
  for (const char* label : {"ate", "ate_m", "comparison", "improvement", "times"})
    EXPECT_THAT(tables, ::testing::HasSubstr("\\label{tab:demo-" + std::string(label) + "}"));
  EXPECT_THAT(tables, ::testing::Not(::testing::HasSubstr("rpe")));
}

TEST_F(PublishedReport, LatexTakesIt) {
  SKIP_WITHOUT_LATEX();
  EXPECT_EQ(testing::latex_complaints(latex_report(results_, "demo")), "");
}

TEST_F(PublishedReport, AsLatexWhatHasFailedIsSaid) {
  for (const std::size_t run : {2, 3}) {  // both of `better` on `walking`
    results_.results[run] = CellResult();
    results_.results[run]->exit_code = 1;
  }
  const std::string tables = latex_report(results_, "demo");
  EXPECT_THAT(tables, ::testing::HasSubstr("-- {\\scriptsize [failed]}"));
  EXPECT_THAT(tables, ::testing::HasSubstr("Variant & $n$ & Better & Worse & By loss &"));
  EXPECT_THAT(tables, ::testing::HasSubstr("    better & 1 & 0 & 1 & 1 &"));
  // 100 (1 - 0.02 / 0.01), of the one run that has a partner.
  EXPECT_THAT(tables, ::testing::HasSubstr("    Sequence & better \\\\\n    \\midrule\n    "
                                           "walking\\_empty & $-$100.0 {\\scriptsize [1 of 2]}"));
}

TEST_F(Report, AsLatexOnlyWhatIsThereIsExplained) {
  Study study = two_by_two(1);
  study.baseline = "plain";
  study.sequences.resize(1);
  StudyResults results{.study = study, .cells = cells_of(study), .results = {}, .command = ""};
  for (int run = 0; run < 2; ++run) results.results.emplace_back(result_with(0.1));
  EXPECT_THAT(
      latex_report(results, "demo"),
      ::testing::AllOf(::testing::HasSubstr("\\caption{Absolute trajectory error, RMSE (m). "
                                            "One run of each.}"),
                       ::testing::Not(::testing::HasSubstr("In brackets:")),
                       ::testing::Not(::testing::HasSubstr("Bold")),
                       ::testing::Not(::testing::HasSubstr("dagger"))));
  results.results[1] = result_with(0.05, 40.0);
  EXPECT_THAT(latex_report(results, "demo"),
              ::testing::HasSubstr("One run of each. In brackets: coverage, where it is below "
                                   "100\\,\\%.}"));
}

TEST(LatexReport, WhatIsNoChanceHasADagger) {
  Study study = two_by_two(1);
  study.baseline = "plain";
  study.sequences.clear();
  for (int i = 0; i < 8; ++i) {
    Sequence sequence;
    sequence.name = sequence.dataset = "room " + std::to_string(i);
    study.sequences.push_back(sequence);
  }
  StudyResults results{.study = study, .cells = cells_of(study), .results = {}, .command = ""};
  for (const Cell& cell : results.cells)
    results.results.emplace_back(result_with(cell.variant == 0 ? 0.1 : 0.02));
  EXPECT_THAT(
      latex_report(results, "demo"),
      ::testing::AllOf(
          ::testing::HasSubstr("    Sequence & plain & better$^\\dagger$ \\\\\n"),
          ::testing::HasSubstr(" $^\\dagger$: differs from plain (signed-rank test across "
                               "recordings, corrected p $<$ 0.05).}\n  \\label{tab:demo-ate}")));
}

TEST_F(Report, NegativeImprovementsKeepTheirSigns) {
  Study study = two_by_two(2);
  study.baseline = "plain";
  study.sequences.resize(1);
  StudyResults results{.study = study, .cells = cells_of(study), .results = {}, .command = ""};
  for (const double ate : {0.1, 0.1, 0.12, 0.105}) results.results.emplace_back(result_with(ate));
  EXPECT_THAT(latex_report(results, "demo"),
              ::testing::HasSubstr("$-$12.5 {\\scriptsize ($-$20.0 to $-$5.0)}"));
}

}  // namespace
}  // namespace stillpoint::study
