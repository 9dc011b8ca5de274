// What is drawn lies where the layout says, in the colours that were asked for.
#include <gtest/gtest.h>

#include <limits>

#include "picture.hpp"

namespace stillpoint::figures {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr Colour kRed{1, 0, 0};

Panel panel_to(double high) { return {"", {"x", 0, high}, {"y", 0, high}}; }

TEST(Marks, ALineRunsThroughItsPointsAndBreaksWhereTheyAreNotFinite) {
  Panel panel = panel_to(10);
  panel.marks.emplace_back(Line{"", {{0, 3}, {4, 3}, {kNan, kNan}, {6, 3}, {10, 3}}, kRed, 3});
  const Picture picture(figure_of(panel));
  EXPECT_TRUE(same(picture.at(0, {2, 3}), kRed));
  EXPECT_TRUE(same(picture.at(0, {7, 3}), kRed));
  EXPECT_TRUE(same(picture.at(0, {5, 3}), kPaper));
}

TEST(Marks, NothingIsDrawnOutsideTheAxes) {
  Panel panel = panel_to(10);
  panel.marks.emplace_back(Line{"", {{-1e6, 5}, {1e6, 5}}, kRed, 3});
  const Picture picture(figure_of(panel));
  EXPECT_TRUE(same(picture.at(0, {5, 5}), kRed));
  const Box& axes = picture.layout().panels[0].axes;
  EXPECT_TRUE(same(picture.at_page({axes.right() + 1, axes.y + axes.height / 2}), kPaper));
}

TEST(Marks, PeaksOfManyPointsStay) {
  Panel panel = panel_to(100'000);
  Line line{"", {}, kRed, 1};
  for (int i = 0; i < 100'000; ++i) line.points.emplace_back(i, i == 50'000 ? 90'000.0 : 1'000.0);
  panel.marks.emplace_back(line);
  const Figure figure = figure_of(panel);
  EXPECT_LT(draw(figure, Format::kSvg).size(), 200'000u);
  const Picture picture(figure);
  EXPECT_GT(picture.at(0, {50'000, 60'000}).red, picture.at(0, {50'000, 60'000}).blue + 0.3);
}

TEST(Marks, LinesWithValuesHaveTheColoursOfTheScale) {
  Panel panel = panel_to(10);
  ValueLine line{{}, {}, 4};
  for (double x = 0; x <= 10; x += 0.1) {
    line.points.emplace_back(x, 5);
    line.values.push_back(x < 5 ? 0 : 2);
  }
  panel.marks.emplace_back(line);
  Figure figure = figure_of(panel);
  figure.colour_scale = ColourScale{"error [m]", {0, 2}};
  const Picture picture(figure);
  EXPECT_TRUE(same(picture.at(0, {3, 5}), value_colour(0)));
  EXPECT_TRUE(same(picture.at(0, {8, 5}), value_colour(1)));
  const Box& bar = picture.layout().colour_bar.value();
  const double middle = bar.x + bar.width / 2;
  EXPECT_TRUE(same(picture.at_page({middle, bar.y + 0.5}), value_colour(1), 0.05));
  EXPECT_TRUE(same(picture.at_page({middle, bar.bottom() - 1}), value_colour(0), 0.05));
}

TEST(Marks, StretchesShadeTheirTimeOrAStripOfIt) {
  Panel panel = panel_to(10);
  panel.marks.emplace_back(Stretch{"", {1, 3}, kRed});
  panel.marks.emplace_back(Stretch{"", {5, 7}, kRed, 0});
  const Picture picture(figure_of(panel));
  EXPECT_LT(picture.at(0, {1.5, 5}).green, 0.9);
  EXPECT_TRUE(same(picture.at(0, {4.3, 5}), kPaper));
  EXPECT_TRUE(same(picture.at(0, {5.5, 5}), kPaper));
  EXPECT_TRUE(same(picture.at(0, {5.5, 9.8}), kRed));
}

TEST(Marks, BarsLieBesideTheirCategoryFromTopToBottom) {
  Panel panel{"", {"ms", 0, 10}, {}};
  panel.y.categories = {"first", "second"};
  panel.marks.emplace_back(Bar{"", {0, 8}, 0, 0.6, kRed});
  panel.marks.emplace_back(Bar{"", {0, 3}, 1, 0.6, kInk});
  const Picture picture(figure_of(panel));
  EXPECT_TRUE(same(picture.at(0, {7, 0}), kRed));
  EXPECT_TRUE(same(picture.at(0, {2.2, 1}), kInk));
  EXPECT_TRUE(same(picture.at(0, {7, 1}), kPaper));
  const PanelPlace& place = picture.layout().panels[0];
  EXPECT_LT(place.on_page({0, 0}).y(), place.on_page({0, 1}).y());
}

}  // namespace
}  // namespace stillpoint::figures
