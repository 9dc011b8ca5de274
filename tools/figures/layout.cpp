#include "figures/layout.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "figures/extent.hpp"

namespace stillpoint::figures {
namespace {

constexpr double kEdgePt = 3;           // of the page, free
constexpr double kRightPt = 6;          // for half of the last number
constexpr double kGapPt = 12;           // between panels beside each other
constexpr double kLinePt = 10;          // of text
constexpr double kBarPt = 6;            // width of the colour bar
constexpr double kBarGapPt = 10;        // left of it
constexpr double kNumbersGuessPt = 20;  // before they are known
constexpr double kLongestCategoryPt = 100;

bool has_values(const Row& row) {
  const auto of_panel = [](const Panel& panel) {
    return std::ranges::any_of(
        panel.marks, [](const Mark& mark) { return std::holds_alternative<ValueLine>(mark); });
  };
  return std::ranges::any_of(row.panels, of_panel);
}

template <class Wanted>
bool any_panel(const Row& row, Wanted wanted) {
  return std::ranges::any_of(row.panels, wanted);
}

double top_of(const Row& row) {
  return any_panel(row, [](const Panel& p) { return !p.title.empty(); }) ? kLinePt + kTextGapPt
                                                                         : kTextGapPt;
}

double bottom_of(const Row& row) {
  const bool numbers = any_panel(row, [](const Panel& p) { return p.x.numbers; });
  const bool label = any_panel(row, [](const Panel& p) { return !p.x.label.empty(); });
  return kTickPt + (numbers ? kLinePt : 0) + (label ? kLinePt : 0) + kTextGapPt;
}

double left_of(const Figure& figure, double numbers_pt) {
  const bool label = std::ranges::any_of(figure.rows, [](const Row& row) {
    return any_panel(row, [](const Panel& p) { return !p.y.label.empty(); });
  });
  return numbers_pt + kTickPt + kTextGapPt + (label ? kLinePt + kTextGapPt : 0);
}

double widest_text(const std::vector<Tick>& ticks) {
  double widest = 0;
  for (const Tick& tick : ticks) widest = std::max(widest, text_width_pt(tick.text, kTextPt));
  return widest;
}

// Space at the right of rows with values: the bar, its numbers and its label.
double colour_bar_space(const Figure& figure) {
  if (!figure.colour_scale) return 0;
  const double numbers = widest_text(ticks_of(figure.colour_scale->values, kColourTicks));
  return kBarGapPt + kBarPt + kTickPt + kTextGapPt + numbers + kLinePt;
}

void place_row(const Figure& figure, const Row& row, double top, Layout& layout) {
  const double left = left_of(figure, layout.numbers_pt);
  const double space = has_values(row) ? colour_bar_space(figure) : 0;
  const double count = static_cast<double>(row.panels.size());
  const double width = (figure.width_pt - kEdgePt - space - (count - 1) * kGapPt) / count;
  double x = kEdgePt;
  for (const Panel& panel : row.panels) {
    PanelPlace place{&panel, {x + left, top, width - left - kRightPt, row.height_pt}, {}, {}};
    place.x = range_along(panel, 0);
    place.y = range_along(panel, 1);
    if (panel.equal_scale) equalise(place.x, place.y, place.axes);
    layout.panels.push_back(place);
    x += width + kGapPt;
  }
  if (space == 0) return;
  const Box& last = layout.panels.back().axes;
  if (!layout.colour_bar) layout.colour_bar = Box{last.right() + kBarGapPt, top, kBarPt, 0};
  layout.colour_bar->height = last.bottom() - layout.colour_bar->y;
}

/// Names from left to right, in as many lines as they need. Returns where the next line would be.
double place_legend(const Figure& figure, double left, Layout& layout) {
  constexpr double kBetween = 12;
  const double most = figure.width_pt - kEdgePt - left - kSamplePt - kTextGapPt;
  std::set<std::string> known;
  Eigen::Vector2d at(left, kEdgePt + kLinePt / 2);
  for (const Row& row : figure.rows)
    for (const Panel& panel : row.panels)
      for (const Mark& mark : panel.marks) {
        const std::string name = name_of(mark);
        if (name.empty() || !known.insert(name).second) continue;
        const std::string text = shortened(name, kTextPt, most);
        const double width = kSamplePt + kTextGapPt + text_width_pt(text, kTextPt);
        if (at.x() > left && at.x() + width > figure.width_pt - kEdgePt)
          at = {left, at.y() + kLinePt};
        layout.legend.push_back({&mark, text, at});
        at.x() += width + kBetween;
      }
  return layout.legend.empty() ? kEdgePt : at.y() + kLinePt / 2 + kTextGapPt;
}

Layout lay_out(const Figure& figure, double numbers_pt) {
  Layout layout{figure.width_pt, 0, {}, {}, numbers_pt, {}};
  double y = place_legend(figure, kEdgePt + left_of(figure, numbers_pt), layout);
  for (const Row& row : figure.rows) {
    y += top_of(row);
    place_row(figure, row, y, layout);
    y += row.height_pt + bottom_of(row);
  }
  layout.height_pt = y + kEdgePt;
  return layout;
}

}  // namespace

std::string name_of(const Mark& mark) {
  return std::visit(
      [](const auto& m) -> std::string {
        if constexpr (requires { m.name; })
          return m.name;
        else
          return {};
      },
      mark);
}

Eigen::Vector2d PanelPlace::on_page(const Eigen::Vector2d& point) const {
  return {axes.x + (point.x() - x.low) / x.span() * axes.width,
          axes.y + (y.high - point.y()) / y.span() * axes.height};
}

std::vector<Tick> PanelPlace::x_ticks() const {
  constexpr double kApartPt = 38;
  return ticks_of(x, axes.width / kApartPt);
}

std::vector<Tick> PanelPlace::y_ticks() const {
  constexpr double kApartPt = 20;
  const std::vector<std::string>& names = panel->y.categories;
  if (names.empty()) return ticks_of(y, axes.height / kApartPt);
  std::vector<Tick> ticks;
  for (const std::string& name : names)
    ticks.push_back(
        {static_cast<double>(ticks.size()), shortened(name, kTextPt, kLongestCategoryPt)});
  return ticks;
}

// The width of the numbers says where the axes begin, which says what numbers stand there.
Layout lay_out(const Figure& figure) {
  const Layout guess = lay_out(figure, kNumbersGuessPt);
  double widest = 0;
  for (const PanelPlace& place : guess.panels)
    if (place.panel->y.numbers) widest = std::max(widest, widest_text(place.y_ticks()));
  return lay_out(figure, widest);
}

}  // namespace stillpoint::figures
