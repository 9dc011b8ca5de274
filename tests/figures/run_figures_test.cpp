// The figures of runs: what they show of their data.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "figures/error_figure.hpp"
#include "figures/share_figure.hpp"
#include "figures/time_figure.hpp"
#include "figures/trajectory_figure.hpp"
#include "picture.hpp"

namespace stillpoint::figures {
namespace {

using ::testing::DoubleNear;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsSupersetOf;

template <class Kind>
std::vector<Kind> marks_of(const Panel& panel) {
  std::vector<Kind> result;
  for (const Mark& mark : panel.marks)
    if (const auto* kind = std::get_if<Kind>(&mark)) result.push_back(*kind);
  return result;
}

std::vector<std::string> names_in(const Figure& figure) {
  std::vector<std::string> names;
  for (const LegendPlace& entry : lay_out(figure).legend) names.push_back(entry.text);
  return names;
}

std::size_t breaks_in(const Points& points) {
  return static_cast<std::size_t>(
      std::ranges::count_if(points, [](const Eigen::Vector2d& p) { return !p.allFinite(); }));
}

/// 10 s along x, `height_m` up and down in z; the estimate is `aside_m` off in y.
RunPath path(const std::string& name, double aside_m, std::size_t count = 101) {
  RunPath run;
  run.name = name;
  for (std::size_t i = 0; i < count; ++i) {
    const double s = 0.1 * static_cast<double>(i);
    run.seconds.push_back(s);
    run.truth.emplace_back(s, 2, 0.1 * std::sin(s));
    run.estimate.emplace_back(s, 2 + aside_m, 0.1 * std::sin(s));
  }
  return run;
}

TEST(TrajectoryFigure, ASingleRunHasTheColoursOfItsErrorInMillimetres) {
  const std::vector<RunPath> runs = {path("one", 0.02)};
  const Figure figure = trajectory_figure(runs);
  ASSERT_EQ(figure.rows.size(), 2u);
  ASSERT_TRUE(figure.colour_scale);
  EXPECT_EQ(figure.colour_scale->label, "error [mm]");
  EXPECT_NEAR(figure.colour_scale->values.high, 20, 1e-9);
  const std::vector<ValueLine> lines = marks_of<ValueLine>(figure.rows[0].panels[0]);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0].values, Each(DoubleNear(20, 1e-9)));
  EXPECT_EQ(lines[0].points[10], Eigen::Vector2d(1, 2.02));
  EXPECT_EQ(figure.rows[1].panels[0].y.label, "z [m]");
}

TEST(TrajectoryFigure, SeveralHaveAColourEach) {
  const std::vector<RunPath> runs = {path("ours", 0.02), path("theirs", 1.5, 60)};
  const Figure figure = trajectory_figure(runs);
  EXPECT_FALSE(figure.colour_scale);
  EXPECT_THAT(names_in(figure), ElementsAre("truth", "ours", "theirs", "start"));
  const std::vector<Line> lines = marks_of<Line>(figure.rows[0].panels[0]);
  EXPECT_EQ(lines[0].points.size(), 101u);  // the truth of the longer one
  EXPECT_NE(lines[1].colour, lines[2].colour);
}

TEST(TrajectoryFigure, ASeventhRunIsTheDashedFirst) {
  std::vector<RunPath> runs;
  for (int i = 0; i < 7; ++i) runs.push_back(path("run " + std::to_string(i), 0.02 * i));
  const std::vector<Line> lines = marks_of<Line>(trajectory_figure(runs).rows[0].panels[0]);
  ASSERT_EQ(lines.size(), 8u);
  EXPECT_EQ(lines[1].colour, lines[7].colour);
  EXPECT_FALSE(lines[1].dashed);
  EXPECT_TRUE(lines[7].dashed);
}

TEST(TrajectoryFigure, LinesBreakWhereTheCameraWasLost) {
  std::vector<RunPath> runs = {path("one", 0.02)};
  runs[0].lost = {{3.0, 3.1}, {7.05, 7.07}};
  for (const Row& row : trajectory_figure(runs).rows) {
    EXPECT_EQ(breaks_in(marks_of<Line>(row.panels[0])[0].points), 2u);
    const ValueLine line = marks_of<ValueLine>(row.panels[0])[0];
    EXPECT_EQ(breaks_in(line.points), 2u);
    EXPECT_EQ(line.values.size(), line.points.size());
  }
}

TEST(TrajectoryFigure, ACameraThatStandsStillCanBeDrawn) {
  std::vector<RunPath> runs = {path("one", 0)};
  std::ranges::fill(runs[0].truth, Eigen::Vector3d(1, 2, 3));
  runs[0].estimate = runs[0].truth;
  for (const Format format : {Format::kPng, Format::kSvg, Format::kPdf})
    EXPECT_FALSE(draw(trajectory_figure(runs), format).empty());
}

RunErrors errors(const std::string& name, double metres) {
  Course course;
  for (int i = 0; i < 100; ++i) {
    course.seconds.push_back(0.1 * i);
    course.values.push_back(metres);
  }
  return {name, course, course, course, {{4.05, 5.05}}, {7}};
}

TEST(ErrorFigure, ShowsBothErrorsLostStretchesLoopsAndTheRootMeanSquare) {
  const std::vector<RunErrors> runs = {errors("one", 0.02)};
  const Figure figure = error_figure(runs, "1 s");
  EXPECT_THAT(names_in(figure), ElementsAre("no pose", "loop closed", "one", "RMSE"));
  const Panel &absolute = figure.rows[0].panels[0], &relative = figure.rows[1].panels[0];
  EXPECT_EQ(absolute.y.label, "ATE [mm]");
  EXPECT_EQ(relative.title, "Relative error over 1 s");
  const std::vector<Line> lines = marks_of<Line>(absolute);
  EXPECT_EQ(breaks_in(lines[0].points), 11u);
  EXPECT_NEAR(lines[0].points[0].y(), 20, 1e-9);
  EXPECT_NEAR(lines[1].points[0].y(), 20, 1e-9);
  EXPECT_FALSE(marks_of<Stretch>(absolute)[0].lane);
  EXPECT_EQ(absolute.x.high, relative.x.high);
}

TEST(ErrorFigure, OfSeveralEachHasALaneForItsLostStretches) {
  const std::vector<RunErrors> runs = {errors("a", 0.02), errors("b", 3)};
  const Panel panel = error_figure(runs, "1 s").rows[0].panels[0];
  EXPECT_EQ(panel.y.label, "ATE [m]");
  std::map<int, Colour> lanes;
  for (const Stretch& stretch : marks_of<Stretch>(panel))
    if (stretch.lane) lanes[*stretch.lane] = stretch.colour;
  ASSERT_EQ(lanes.size(), 2u);
  EXPECT_EQ(lanes[1], marks_of<Line>(panel)[1].colour);
}

TEST(ErrorFigure, WithoutErrorsThereAreAxes) {
  const std::vector<RunErrors> runs = {{"nothing", {}, {}, {}, {}, {}}};
  EXPECT_FALSE(draw(error_figure(runs, "1 s"), Format::kSvg).empty());
}

TEST(ShareFigure, IsInPercent) {
  const std::vector<RunShare> runs = {{"one", {{0, 1, 2}, {0, 0.25, 0.5}}, {}}};
  const Panel panel = share_figure(runs).rows[0].panels[0];
  EXPECT_EQ(marks_of<Line>(panel)[0].points[1], Eigen::Vector2d(1, 25));
  EXPECT_EQ(panel.y.low, 0);
}

TEST(StageTimeFigure, StacksTheMeansToThatOfAFrame) {
  const std::vector<RunTimes> runs = {
      {"a", {{"source", 5, 5, 6, 7}, {"track", 10, 9, 20, 30}}},
      {"b", {{"source", 4, 4, 5, 6}, {"check", 2, 2, 3, 4}, {"track", 8, 7, 9, 10}}}};
  const Figure figure = stage_time_figure(runs);
  EXPECT_THAT(names_in(figure), ElementsAre("source", "track", "check", "a", "b"));
  const Panel& stacked = figure.rows[0].panels[0];
  EXPECT_THAT(stacked.y.categories, ElementsAre("a", "b"));
  std::map<double, double> ends;
  for (const Bar& bar : marks_of<Bar>(stacked)) {
    EXPECT_NEAR(bar.x.low, ends[bar.y], 1e-12);
    ends[bar.y] = bar.x.high;
  }
  EXPECT_NEAR(ends[0], 15, 1e-12);
  EXPECT_NEAR(ends[1], 14, 1e-12);
  EXPECT_NEAR(marks_of<Bar>(figure.rows[1].panels[0])[5].x.high, 30, 1e-12);

  const Figure of_variants = variant_time_figure(runs);
  ASSERT_EQ(of_variants.rows.size(), 1u);
  EXPECT_EQ(marks_of<Bar>(of_variants.rows[0].panels[0]).size(), marks_of<Bar>(stacked).size());
}

TEST(StageTimeFigure, StagesOfLittleCostAreOnePiece) {
  RunTimes run{"one", {}};
  for (int i = 0; i < 14; ++i) {
    const double ms = 1 + i;
    run.stages.push_back({"stage " + std::to_string(i), ms, ms, ms, ms});
  }
  const Figure figure = stage_time_figure(std::vector<RunTimes>{run});
  const std::vector<Bar> bars = marks_of<Bar>(figure.rows[0].panels[0]);
  ASSERT_EQ(bars.size(), kPartColours + 1);
  EXPECT_EQ(bars.back().name, "other stages");
  EXPECT_NEAR(bars.back().x.span(), 1 + 2 + 3 + 4 + 5, 1e-9);
  EXPECT_NEAR(bars.back().x.high, 14 * 15 / 2, 1e-9);
  EXPECT_EQ(figure.rows[1].panels[0].y.categories.size(), 14u);
}

TEST(FrameTimeFigure, HasALineForEachOfTheCostliestStages) {
  std::vector<StageCourse> stages;
  for (int i = 0; i < 9; ++i)
    stages.push_back({"stage " + std::to_string(i), {0, 1, 2}, {1.0 * i, 2.0 * i, 1.0 * i}});
  const Figure figure = frame_time_figure(stages);
  EXPECT_EQ(names_in(figure).size(), kRunColours);
  EXPECT_THAT(names_in(figure), IsSupersetOf({"stage 8", "stage 3"}));
}

}  // namespace
}  // namespace stillpoint::figures
