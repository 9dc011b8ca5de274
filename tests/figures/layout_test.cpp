#include "figures/layout.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "picture.hpp"

namespace stillpoint::figures {
namespace {

Panel with_line(Points points) {
  Panel panel{"", {"x [m]"}, {"y [m]"}};
  panel.marks.emplace_back(Line{"run", std::move(points)});
  return panel;
}

TEST(Layout, EqualScalesHaveUnitsOfOneLength) {
  Panel panel = with_line({{0, 0}, {8, 1}});
  panel.equal_scale = true;
  const Figure figure = figure_of(panel);
  const PanelPlace place = lay_out(figure).panels[0];
  EXPECT_NEAR(place.x.span() / place.axes.width, place.y.span() / place.axes.height, 1e-12);
  EXPECT_LE(place.x.low, 0);
  EXPECT_GE(place.x.high, 8);
}

TEST(Layout, AxesOfOneFigureBeginOneBelowTheOther) {
  Figure figure = figure_of(with_line({{0, 0}, {1, 0.001}}));
  figure.rows.push_back({50, {with_line({{0, 0}, {1, 50'000}})}});
  const Layout layout = lay_out(figure);
  EXPECT_EQ(layout.panels[0].axes.x, layout.panels[1].axes.x);
  EXPECT_EQ(layout.panels[0].axes.right(), layout.panels[1].axes.right());
  EXPECT_GT(layout.panels[1].axes.y, layout.panels[0].axes.bottom());
  EXPECT_LT(layout.panels[1].axes.bottom(), layout.height_pt);
  EXPECT_GT(layout.panels[0].axes.x, layout.numbers_pt);
}

TEST(Layout, AnAxisOfOneNumberOrNoneStillHasLength) {
  for (const Points& points : {Points{{3, 3}, {3, 3}}, Points{{1e15, -1e15}}, Points{}}) {
    const Figure figure = figure_of(with_line(points));
    const PanelPlace place = lay_out(figure).panels[0];
    EXPECT_GT(place.x.span(), 0);
    EXPECT_GT(place.y.span(), 0);
    EXPECT_FALSE(draw(figure, Format::kPng).empty());
  }
}

TEST(Layout, TheColourBarAndItsLabelStayOnThePage) {
  for (const double most : {0.00123, 5.8, 1'234.0}) {
    Panel panel{"", {"x [m]"}, {"y [m]"}};
    panel.marks.emplace_back(ValueLine{{{0, 0}, {1, 1}}, {0, most}});
    Figure figure = figure_of(panel);
    figure.colour_scale = ColourScale{"error [mm]", {0, most}};
    const Picture picture(figure);
    const Box bar = picture.layout().colour_bar.value();
    double numbers = 0;
    for (const Tick& tick : ticks_of({0, most}, kColourTicks))
      numbers = std::max(numbers, text_width_pt(tick.text, kTextPt));
    EXPECT_LT(bar.right() + kTickPt + 2 * kTextGapPt + numbers + kTextPt,
              picture.layout().width_pt);
    EXPECT_GT(bar.x, picture.layout().panels[0].axes.right());
  }
}

TEST(Layout, TheLegendHasEachNameOnceAndStaysOnThePage) {
  Panel panel = with_line({{0, 0}, {1, 1}});
  for (int i = 0; i < 9; ++i) {
    panel.marks.emplace_back(Line{"run number " + std::to_string(i), {{0, 0}, {1, 1}}});
    panel.marks.emplace_back(Stretch{"no pose", {0.1 * i, 0.1 * i + 0.05}});
  }
  panel.marks.emplace_back(Dot{std::string(300, 'w'), {0, 0}});
  const Figure figure = figure_of(panel);
  const Layout layout = lay_out(figure);
  EXPECT_EQ(layout.legend.size(), 12u);
  std::set<std::string> texts;
  for (const LegendPlace& entry : layout.legend) {
    texts.insert(entry.text);
    const double end = entry.at.x() + kSamplePt + text_width_pt(entry.text, kTextPt);
    EXPECT_LT(end, layout.width_pt) << entry.text;
    EXPECT_LT(entry.at.y(), layout.panels[0].axes.y) << entry.text;
  }
  EXPECT_EQ(texts.size(), 12u);
  EXPECT_THAT(layout.legend.back().text, ::testing::EndsWith("w…"));
}

}  // namespace
}  // namespace stillpoint::figures
