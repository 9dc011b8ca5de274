// Tables of runs and studies, and what other programs read of them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/report_tables.hpp"
#include "report/run_tables.hpp"
#include "report/table_files.hpp"
#include "study/fixtures.hpp"
#include "support/latex.hpp"

namespace stillpoint::report {
namespace {

using study::Table;
using ::testing::HasSubstr;
using ::testing::Not;

const std::vector<std::string> kOrigins = {"commit 1", "commit 2"};

TEST(LatexTables, AreBooktabsWithTheBestInBoldAndNothingThatLatexTakesForACommand) {
  const Table table{.title = "50 % & more_or_less",
                    .note = "a~b",
                    .header = {"run", "plain †"},
                    .rows = {{{.text = "fr3_walking"}, {.text = "1–2", .value = 1.0, .best = true}},
                             {{.text = "x"}, {.text = "< 0.01", .significant = true}}}};
  const std::string text = latex_tables({&table, 1}, kOrigins);
  EXPECT_THAT(text, HasSubstr("% commit 1\n% commit 2\n"));
  EXPECT_THAT(text, HasSubstr("\\caption{50 \\% \\& more\\_or\\_less. a\\textasciitilde{}b}"));
  EXPECT_THAT(text, HasSubstr("run & plain $^\\dagger$ \\\\\n    \\midrule"));
  EXPECT_THAT(text, HasSubstr("fr3\\_walking & \\textbf{1--2} \\\\"));
  EXPECT_THAT(text, HasSubstr("x & $<$ 0.01$^\\dagger$ \\\\\n    \\bottomrule"));
}

TEST(LatexTables, LatexTakesThem) {
  SKIP_WITHOUT_LATEX();
  std::string all;
  for (char c = ' '; c <= '~'; ++c) all += c;
  const Table table{.title = all,
                    .note = all,
                    .header = {"run", "plain †"},
                    .rows = {{{.text = all}, {.text = "−1–2 × 3", .value = 1.0, .best = true}},
                             {{.text = "[größer]"}, {.text = "< 0.01", .significant = true}}}};
  EXPECT_EQ(testing::latex_complaints(latex_tables({&table, 1}, {{all}})), "");
}

TEST(CsvTables, HaveALinePerFigure) {
  const Table table{
      .title = "a, \"b\"",
      .header = {"run", "ATE", "RPE"},
      .rows = {
          {{.text = "r"}, {.text = "0.1235", .value = 0.123456, .best = true}, {.text = "–"}}}};
  EXPECT_EQ(csv_tables({&table, 1}, kOrigins),
            "table,row,column,value,text,best,origin\n"
            "\"a, \"\"b\"\"\",r,ATE,0.123456,0.1235,1,commit 1 | commit 2\n"
            "\"a, \"\"b\"\"\",r,RPE,,–,0,commit 1 | commit 2\n");
}

RunData run_with(const char* name, double ate, double coverage) {
  RunData run{.name = name, .recording = "walking", .coverage = coverage};
  run.evaluation.emplace();
  run.evaluation->rigid.metres.rmse = ate;
  return run;
}

TEST(RunTable, ASmallErrorOfAPartOfTheRecordingIsNotTheBest) {
  const std::vector<RunData> runs = {run_with("a", 0.02, 1.0), run_with("b", 0.03, 0.995),
                                     run_with("early", 0.001, 0.4)};
  const Table table = run_table(runs);
  EXPECT_TRUE(table.rows[0][1].best);
  EXPECT_FALSE(table.rows[1][1].best);
  EXPECT_FALSE(table.rows[2][1].best);
  EXPECT_EQ(table.rows[2][1].text, "0.0010");
}

TEST(RunTable, ASmallErrorOfARunThatLostItsWayIsNotTheBest) {
  std::vector<RunData> runs = {run_with("a", 0.02, 1.0), run_with("b", 0.03, 1.0),
                               run_with("lost", 0.001, 1.0)};
  runs[0].times_lost = runs[1].times_lost = 0;
  runs[2].times_lost = 3;
  const Table table = run_table(runs);
  EXPECT_TRUE(table.rows[0][1].best);
  EXPECT_FALSE(table.rows[2][1].best);
}

TEST(RunTable, WhatReadsTheSameIsEquallyGood) {
  const std::vector<RunData> runs = {run_with("a", 0.02001, 1.0), run_with("b", 0.02002, 1.0),
                                     run_with("c", 0.05, 1.0)};
  const Table table = run_table(runs);
  EXPECT_TRUE(table.rows[0][1].best);
  EXPECT_TRUE(table.rows[1][1].best);
  EXPECT_FALSE(table.rows[2][1].best);
}

TEST(LatexTables, TwoColumnsMayNameARow) {
  Table table{.title = "t",
              .header = {"sequence", "variant", "mean"},
              .rows = {{{.text = "walking"}, {.text = "plain"}, {.text = "0.1", .value = 0.1}}}};
  table.names = 2;
  EXPECT_THAT(latex_tables({&table, 1}, kOrigins), HasSubstr("\\begin{tabular}{llr}"));
  EXPECT_THAT(csv_tables({&table, 1}, kOrigins),
              HasSubstr("t,walking/plain,mean,0.1,0.1,0,commit 1 | commit 2\n"));
}

/// Of all cells but those of the last `missing`.
study::StudyResults results_of(const study::Study& study, std::size_t missing) {
  study::StudyResults results{
      .study = study, .cells = cells_of(study), .results = {}, .command = {}};
  for (const study::Cell& cell : results.cells)
    results.results.emplace_back(study::result_with(cell.variant == 0 ? 0.1 : 0.02));
  for (std::size_t i = 0; i < missing; ++i) results.results[results.results.size() - 1 - i].reset();
  return results;
}

TEST(StudyTables, HaveTheBestOfEachRowAndSayWhatIsMissing) {
  study::Study study = study::two_by_two(3);
  study.baseline = "plain";
  const std::vector<Table> tables = report_tables(results_of(study, 1));
  ASSERT_GE(tables.size(), 4u);
  EXPECT_EQ(tables[0].title, "Absolute trajectory error, SE(3), RMSE (m)");
  EXPECT_EQ(tables[0].rows[0][1].text, "0.1000 (0.1000–0.1000)");
  EXPECT_FALSE(tables[0].rows[0][1].best);
  EXPECT_TRUE(tables[0].rows[0][2].best);
  EXPECT_EQ(tables[0].rows[1][2].text, "0.0200 (0.0200–0.0200) [2 of 3]");
  EXPECT_EQ(tables[1].title, "Compared with plain, recording by recording");
  EXPECT_EQ(tables[2].rows[0][2].text, "80.0 (80.0–80.0)");
  EXPECT_THAT(tables[0].note, HasSubstr("Median (smallest–largest) of 3 runs. Bold: the best"));
  // One recording can show nothing: no dagger, and p says so.
  EXPECT_THAT(tables[0].header[2], Not(HasSubstr("†")));
  EXPECT_EQ(tables[1].rows[0].back().text, "1.0000 (at least 1.0000)");
  EXPECT_THAT(tables[1].note, Not(HasSubstr("†")));
  for (const Table& table : tables) EXPECT_THAT(table.title, Not(HasSubstr("lost")));
}

TEST(StudyTables, HaveThePenaltyAndWhatOthersHavePublished) {
  study::Study study = study::two_by_two(1);
  study.published = {{.name = "Theirs",
                      .source = "Table I",
                      .errors = {{"walking", {.ate_m = {0.25}}}},
                      .times = {}}};
  const std::vector<Table> tables = report_tables(results_of(study, 0));
  EXPECT_EQ(tables[0].header[3], "Theirs (published)");
  EXPECT_EQ(tables[0].rows[0][3].text, "0.2500");
  EXPECT_FALSE(tables[0].rows[0][3].best);
  EXPECT_EQ(tables[0].rows[1][3].text, "–");
  EXPECT_THAT(tables[0].note, HasSubstr("Published, not measured here: Theirs (Table I)."));
  const auto penalty = std::ranges::find_if(
      tables, [](const Table& table) { return table.title.starts_with("Dynamic penalty"); });
  ASSERT_NE(penalty, tables.end());
  ASSERT_EQ(penalty->rows.size(), 1u);  // the twin has none
  EXPECT_EQ(penalty->rows[0][0].text, "walking");
  EXPECT_EQ(penalty->rows[0][1].text, "1.00");
}

TEST(StudyTables, WhatIsNoChanceHasADagger) {
  study::Study study = study::two_by_two(1);
  study.baseline = "plain";
  study.sequences.clear();
  for (int i = 0; i < 8; ++i) {
    study::Sequence sequence;
    sequence.name = sequence.dataset = "room " + std::to_string(i);
    study.sequences.push_back(sequence);
  }
  const std::vector<Table> tables = report_tables(results_of(study, 0));
  EXPECT_EQ(tables[0].header[2], "better †");
  EXPECT_THAT(tables[0].note, HasSubstr("differs from plain"));
  EXPECT_TRUE(tables[1].rows[0].back().significant);
  EXPECT_THAT(tables[1].note, HasSubstr("†: corrected p below 0.05."));
}

}  // namespace
}  // namespace stillpoint::report
