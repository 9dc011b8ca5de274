#include "figures/evaluation_figure.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/fixtures.hpp"
#include "picture.hpp"

namespace stillpoint::figures {
namespace {

using evaluation::Contestant;
using evaluation::Trajectory;

/// A winding path of 5 s that wobbles by `metres`; poses from `first` to before `last` of 50.
Contestant wobbling(const std::string& name, double metres, long first = 0, long last = 50) {
  const Trajectory path = evaluation::winding_path(50, 0.1);
  Trajectory estimate = path;
  for (std::size_t i = 0; i < estimate.poses.size(); ++i)
    estimate.poses[i].world_from_camera.translation().x() += i % 2 == 0 ? metres : -metres;
  estimate.poses.erase(estimate.poses.begin() + last, estimate.poses.end());
  estimate.poses.erase(estimate.poses.begin(), estimate.poses.begin() + first);
  Contestant result{name, evaluation::evaluate(path, estimate, {}, {}), {}};
  result.error = result.evaluation.rigid;
  return result;
}

std::vector<std::string> legend_of(const Figure& figure) {
  std::vector<std::string> texts;
  for (const LegendPlace& entry : lay_out(figure).legend) texts.push_back(entry.text);
  return texts;
}

TEST(EvaluationFigure, OfOneRunHasItsErrorAsColours) {
  const std::vector<Contestant> runs = {wobbling("mine", 0.01)};
  const Figure figure = evaluation_figure(runs);
  EXPECT_TRUE(figure.colour_scale);
  EXPECT_THAT(legend_of(figure),
              ::testing::Contains(::testing::StartsWith("mine: ATE RMSE 10.0 mm, 50 poses")));
  const Picture picture(figure);
  EXPECT_GT(picture.pixels().cols, picture.pixels().rows);
}

TEST(EvaluationFigure, SaysWhereARunHasNoPoses) {
  const std::vector<Contestant> runs = {wobbling("whole", 0.01), wobbling("late", 0.01, 10),
                                        wobbling("gave_up", 0.01, 0, 20)};
  const Figure figure = evaluation_figure(runs);
  EXPECT_FALSE(figure.colour_scale);
  std::vector<Stretch> lost;
  for (const Mark& mark : figure.rows.back().panels[0].marks)
    if (const auto* stretch = std::get_if<Stretch>(&mark)) lost.push_back(*stretch);
  ASSERT_EQ(lost.size(), 2u);
  EXPECT_EQ(lost[0].lane, 1);
  EXPECT_NEAR(lost[0].x.low, 0, 1e-9);
  EXPECT_NEAR(lost[0].x.high, 1, 1e-9);
  EXPECT_EQ(lost[1].lane, 2);
  EXPECT_NEAR(lost[1].x.low, 1.9, 1e-9);
  EXPECT_NEAR(lost[1].x.high, 4.9, 1e-9);
}

TEST(EvaluationFigure, ACameraThatStandsStillCanBeDrawn) {
  Trajectory still = evaluation::winding_path(20, 0.1);
  for (StampedPose& pose : still.poses) pose.world_from_camera = Pose::Identity();
  Contestant run{"still", evaluation::evaluate(still, still, {}, {}), {}};
  run.error = run.evaluation.rigid;
  const std::vector<Contestant> runs = {run};
  for (const Format format : {Format::kPng, Format::kSvg, Format::kPdf})
    EXPECT_FALSE(draw(evaluation_figure(runs), format).empty());
}

}  // namespace
}  // namespace stillpoint::figures
