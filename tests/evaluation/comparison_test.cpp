#include "evaluation/comparison.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <utility>
#include <vector>

#include "evaluation/best.hpp"
#include "evaluation/format.hpp"
#include "fixtures.hpp"

namespace stillpoint::evaluation {
namespace {

using testing::HasSubstr;

/// A winding path of 5 s that wobbles by `metres`, the first `count` of 50 poses.
Contestant wobbling(const std::string& name, double metres, std::size_t count = 50) {
  const Trajectory path = winding_path(50, 0.1);
  Trajectory estimate = path;
  estimate.poses.resize(count);
  for (std::size_t i = 0; i < count; ++i)
    estimate.poses[i].world_from_camera.translation().x() += i % 2 == 0 ? metres : -metres;
  Contestant result{name, evaluate(path, estimate, {}, {}), {}};
  result.error = absolute_error(result.evaluation.reference, result.evaluation.estimate,
                                result.evaluation.pairs, AlignmentKind::kRigid);
  return result;
}

Comparison of_three() {
  Comparison comparison;
  comparison.contestants.push_back(wobbling("stillpoint", 0.01));
  comparison.contestants.push_back(wobbling("große Karte", 0.03));
  comparison.contestants.push_back(wobbling("gave_up", 0.001, 20));
  return comparison;
}

TEST(Comparison, TheBestOfThoseThatCoverAsMuchHasAStar) {
  const std::string table = comparison_table(of_three());
  EXPECT_THAT(table, testing::ContainsRegex("stillpoint +100.0 +50 +0.0[01][0-9]+[*]"));
  EXPECT_THAT(table, testing::ContainsRegex("gave_up +38.8 +20 +0.0010 "));
  std::vector<std::size_t> widths;
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) widths.push_back(width_of(line));
  ASSERT_EQ(widths.size(), 6u);
  EXPECT_THAT(widths, testing::Each(widths[0]));
}

TEST(Comparison, KeyFramesAloneGetNoStar) {
  Comparison comparison;
  comparison.contestants.push_back(wobbling("all", 0.03));
  comparison.contestants.push_back(wobbling("half", 0.02));
  comparison.contestants.push_back(wobbling("keyframes", 0.01));
  for (const auto& [k, step] : {std::pair(1, 2), std::pair(2, 10)}) {
    Trajectory thinned = comparison.contestants[static_cast<std::size_t>(k)].evaluation.estimate;
    std::vector<StampedPose> kept;
    for (std::size_t i = 0; i < 50; i += static_cast<std::size_t>(step))
      kept.push_back(thinned.poses[i]);
    thinned.poses = kept;
    Contestant& one = comparison.contestants[static_cast<std::size_t>(k)];
    one.evaluation = evaluate(one.evaluation.reference, thinned, {}, {});
    one.evaluation.span.share = 1;
    one.error.metres.rmse = k == 1 ? 0.02 : 0.01;
  }
  const std::string table = comparison_table(comparison);
  EXPECT_THAT(table, testing::ContainsRegex("half +100.0 +25 +0.0200[*]"));
  EXPECT_THAT(table, testing::ContainsRegex("keyframes +100.0 +5 +0.0100 "));
}

TEST(Best, IsAmongThoseThatCoverAsMuchAndReadsAsTheBest) {
  using testing::ElementsAre;
  const std::vector<std::optional<RatedFigure>> figures = {
      RatedFigure{0.02001, 99.5}, RatedFigure{0.02002, 100.0}, RatedFigure{0.05, 100.0},
      RatedFigure{0.001, 40.0}, std::nullopt};
  EXPECT_THAT(best_of(figures, Better::kSmaller, 4), ElementsAre(true, true, false, false, false));
  EXPECT_THAT(best_of(figures, Better::kLarger, 4), ElementsAre(false, false, true, false, false));
  EXPECT_THAT(best_of(figures, Better::kNeither, 4), testing::Each(false));
  EXPECT_THAT(best_of(figures, Better::kSmaller, 1), ElementsAre(true, true, false, false, false));
  EXPECT_THAT(best_of(figures, Better::kSmaller, 0), testing::Each(false));  // all read the same
  EXPECT_THAT(best_of({figures.begin(), 1}, Better::kSmaller, 4), ElementsAre(false));
}

TEST(Comparison, AloneNobodyIsBest) {
  Comparison comparison;
  comparison.contestants.push_back(wobbling("one", 0.01));
  EXPECT_THAT(comparison_table(comparison), testing::Not(HasSubstr("*")));
}

TEST(Comparison, JsonHasAllFiguresOfEach) {
  const Comparison comparison = of_three();
  const nlohmann::ordered_json json = comparison_json(comparison);
  ASSERT_EQ(json.size(), 3u);
  EXPECT_EQ(json[1]["name"], "große Karte");
  EXPECT_EQ(json[1]["aligned"]["position_m"]["rmse"], comparison.contestants[1].error.metres.rmse);
  EXPECT_EQ(json[1]["ate"]["se3_m"]["rmse"], comparison.contestants[1].error.metres.rmse);
}

}  // namespace
}  // namespace stillpoint::evaluation
