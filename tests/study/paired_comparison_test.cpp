#include "study/paired_comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "fixtures.hpp"
#include "study/table_cells.hpp"

namespace stillpoint::study {
namespace {

/// `recordings` sequences, the baseline `plain` with an ATE of 0.1 m, and `better` as asked for.
class Comparison : public ::testing::Test {
 protected:
  PairedComparison compared(std::size_t recordings,
                            const std::function<CellResult(std::size_t, int)>& better) {
    study_.sequences.clear();
    for (std::size_t i = 0; i < recordings; ++i) {
      Sequence sequence;
      sequence.name = std::to_string(i);
      sequence.scene = "room " + std::to_string(i / cameras_);
      study_.sequences.push_back(sequence);
    }
    study_.baseline = "plain";
    StudyResults results{.study = study_, .cells = cells_of(study_), .results = {}, .command = ""};
    for (const Cell& cell : results.cells) {
      CellResult result = cell.variant == 0 ? result_with(0.1, baseline_coverage_(cell.repeat))
                                            : better(cell.sequence, cell.repeat);
      result.values[kCpuPerFrame] = cell.variant == 0 ? 20.0 : 30.0;
      results.results.emplace_back(std::move(result));
    }
    const std::vector<PairedComparison> all = compare_with_baseline(results);
    EXPECT_EQ(all.size(), 1u);
    return all.at(0);
  }
  Study study_ = two_by_two(1);
  std::size_t cameras_ = 1;  // that each recording is run with
  std::function<double(int)> baseline_coverage_ = [](int) { return 100.0; };  // %, by repeat
};

TEST_F(Comparison, CountsRecordingsAndTheirRatios) {
  const PairedComparison result =
      compared(6, [](std::size_t sequence, int) { return result_with(0.05 + 0.005 * sequence); });
  EXPECT_EQ(result.better, 6u);
  EXPECT_EQ(result.worse, 0u);
  EXPECT_NEAR(result.ate_ratio->median, 0.625, 1e-9);
  EXPECT_NEAR(result.ate_ratio->first_quartile, 0.5625, 1e-9);
  EXPECT_NEAR(result.time_ratio->median, 1.5, 1e-9);
  EXPECT_DOUBLE_EQ(result.effect, 1.0);
  EXPECT_DOUBLE_EQ(result.p, 2.0 / 64);
}

TEST_F(Comparison, RepeatsOnOneRecordingAreOnePair) {
  study_.repeats = 3;
  const auto better = [](std::size_t, int repeat) { return result_with(0.05 + 0.1 * repeat); };
  EXPECT_EQ(compared(2, better).worse, 2u);
  study_.new_noise = true;  // of the same scene
  EXPECT_EQ(compared(2, better).worse, 2u);
  EXPECT_EQ(compared(2, better).recordings, 2u);
}

TEST_F(Comparison, OfTwoRepeatsNeitherSideIsFavoured) {
  study_.repeats = 2;
  const auto of = [](double first, double second, double first_coverage = 100.0) {
    return [=](std::size_t, int repeat) {
      return repeat == 0 ? result_with(first, first_coverage) : result_with(second);
    };
  };
  EXPECT_EQ(compared(2, of(0.08, 0.11)).better, 2u);
  EXPECT_EQ(compared(2, of(0.11, 0.08)).better, 2u);
  EXPECT_EQ(compared(2, of(0.12, 0.09)).worse, 2u);
  EXPECT_NEAR(compared(2, of(0.05, 0.2)).ate_ratio->median, 1.0, 1e-9);
  EXPECT_EQ(compared(2, of(0.05, 0.08, 90.0)).worse, 2u) << "one of them covers less";
}

TEST_F(Comparison, OneRunThatCoversMoreAndOneThatCoversLessCancel) {
  study_.repeats = 2;
  baseline_coverage_ = [](int repeat) { return repeat == 0 ? 100.0 : 90.0; };
  const PairedComparison even = compared(
      2, [](std::size_t, int repeat) { return result_with(0.1, repeat == 0 ? 90.0 : 100.0); });
  EXPECT_EQ(even.better + even.worse, 0u);
  EXPECT_EQ(even.incomplete, 2u);
  EXPECT_FALSE(even.ate_ratio);
}

TEST_F(Comparison, OneRecordingWithTwoCamerasIsOnePair) {
  cameras_ = 2;
  const PairedComparison result =
      compared(6, [](std::size_t sequence, int) { return result_with(0.05 + 0.005 * sequence); });
  EXPECT_EQ(result.better, 3u);
  EXPECT_DOUBLE_EQ(result.p, 2.0 / 8);
}

TEST_F(Comparison, WhoeverCoversLessCannotWin) {
  const PairedComparison less =
      compared(5, [](std::size_t, int) { return result_with(0.001, 90.0); });
  EXPECT_EQ(less.worse, 5u);
  EXPECT_EQ(less.incomplete, 5u);
  EXPECT_FALSE(less.ate_ratio);
  EXPECT_DOUBLE_EQ(less.effect, -1.0);
  EXPECT_EQ(compared(5, [](std::size_t, int) { return result_with(0.001, 99.5); }).better, 5u);
}

TEST_F(Comparison, WhoeverLosesTrackingCannotWin) {
  const PairedComparison lost = compared(5, [](std::size_t, int) {
    CellResult result = result_with(0.001);
    result.values[kTimesLost] = 1.0;
    return result;
  });
  EXPECT_EQ(lost.worse, 5u);
}

TEST_F(Comparison, AFailedRunIsWorseThanAnyOther) {
  const PairedComparison failed = compared(5, [](std::size_t sequence, int) {
    CellResult result = result_with(0.099);
    if (sequence > 0) return result;
    CellResult failure;
    failure.exit_code = 1;
    return failure;
  });
  EXPECT_EQ(failed.better, 4u);
  EXPECT_EQ(failed.worse, 1u);
  EXPECT_EQ(failed.incomplete, 1u);
  EXPECT_NEAR(failed.effect, (10.0 - 5.0) / 15.0, 1e-12);
}

TEST_F(Comparison, TooFewRecordingsForADifferenceAreNamed) {
  const auto better = [](std::size_t, int) { return result_with(0.05); };
  EXPECT_EQ(recordings_note({compared(6, better)}), "");
  EXPECT_EQ(recordings_note({compared(5, better)}),
            "At least: the smallest p that so few recordings can give, however large the "
            "difference; with 1 comparison, it takes 6 recordings to come below 0.05.");
  std::vector<PairedComparison> seven(7, compared(8, better));
  for (PairedComparison& one : seven) one.least_p = 7.0 / 128;
  EXPECT_THAT(recordings_note(seven),
              ::testing::HasSubstr("with 7 comparisons, it takes 9 recordings"));
}

TEST_F(Comparison, TheSmallestPDependsOnTheRecordingsOfAllVariants) {
  Study study = two_by_two(1);
  study.baseline = "plain";
  Variant partly = study.variants[1];
  partly.name = "partly";
  partly.only = {"0", "1", "2"};
  study.variants.push_back(partly);
  study.sequences.clear();
  for (int i = 0; i < 8; ++i) {
    Sequence sequence;
    sequence.name = std::to_string(i);
    sequence.dataset = "room " + sequence.name;
    study.sequences.push_back(sequence);
  }
  StudyResults results{.study = study, .cells = cells_of(study), .results = {}, .command = ""};
  for (const Cell& cell : results.cells)
    results.results.emplace_back(result_with(cell.variant == 0 ? 0.1 : 0.05));
  const std::vector<PairedComparison> all = compare_with_baseline(results);
  ASSERT_EQ(all.size(), 2u);
  EXPECT_DOUBLE_EQ(all[0].least_p, 2.0 * 2.0 / 256);
  EXPECT_TRUE(all[0].can_be_significant());
  EXPECT_DOUBLE_EQ(all[1].least_p, 2.0 / 8);
  EXPECT_FALSE(all[1].can_be_significant());
}

TEST_F(Comparison, NeedsABaseline) {
  const StudyResults results{.study = study_, .cells = {}, .results = {}, .command = ""};
  EXPECT_TRUE(compare_with_baseline(results).empty());
}

TEST(RatioCells, SmallRatiosCanBeToldFromNone) {
  EXPECT_EQ(ratio_cell(spread_of({0.0030, 0.0034, 0.0044})).text, "0.0034 (0.0032–0.0039)");
  EXPECT_EQ(ratio_cell(spread_of({0.0012, 0.003, 0.8, 1.0, 1.0})).text, "0.8000 (0.0030–1.0000)");
  EXPECT_EQ(ratio_cell(spread_of({0.9})).text, "0.90");
}

}  // namespace
}  // namespace stillpoint::study
