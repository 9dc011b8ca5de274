#include "figures/axes.hpp"

#include <algorithm>

namespace stillpoint::figures {
namespace {

const Pen kGrid{kGridGrey, 0.5}, kAxis{kInk, 0.6};

void draw_x_axis(Canvas& canvas, const PanelPlace& place) {
  const Box& axes = place.axes;
  const Axis& axis = place.panel->x;
  const double end = axes.bottom() + kTickPt, below = end + kTextGapPt;
  canvas.line(Points{{axes.x, axes.bottom()}, {axes.right(), axes.bottom()}}, kAxis);
  for (const Tick& tick : place.x_ticks()) {
    const double x = place.on_page({tick.at, 0}).x();
    canvas.line(Points{{x, axes.bottom()}, {x, end}}, kAxis);
    if (axis.numbers) canvas.text(tick.text, {x, below}, kTextPt, {0.5, 0});
  }
  const double label = below + (axis.numbers ? kTextPt + kTextGapPt : 0);
  canvas.text(axis.label, {axes.x + axes.width / 2, label}, kTextPt, {0.5, 0});
}

void draw_y_axis(Canvas& canvas, const PanelPlace& place, double numbers_pt) {
  const Box& axes = place.axes;
  const Axis& axis = place.panel->y;
  const double end = axes.x - kTickPt, beside = end - kTextGapPt;
  canvas.line(Points{{axes.x, axes.y}, {axes.x, axes.bottom()}}, kAxis);
  for (const Tick& tick : place.y_ticks()) {
    const double y = place.on_page({0, tick.at}).y();
    canvas.line(Points{{axes.x, y}, {end, y}}, kAxis);
    if (axis.numbers) canvas.text(tick.text, {beside, y}, kTextPt, {1, 0.5});
  }
  const double label = beside - numbers_pt - 2 * kTextGapPt;
  canvas.text(axis.label, {label, axes.y + axes.height / 2}, kTextPt, {0.5, 1}, true);
}

}  // namespace

void draw_grid(Canvas& canvas, const PanelPlace& place) {
  const Box& axes = place.axes;
  for (const Tick& tick : place.x_ticks()) {
    const double x = place.on_page({tick.at, 0}).x();
    canvas.line(Points{{x, axes.y}, {x, axes.bottom()}}, kGrid);
  }
  if (!place.panel->y.categories.empty()) return;
  for (const Tick& tick : place.y_ticks()) {
    const double y = place.on_page({0, tick.at}).y();
    canvas.line(Points{{axes.x, y}, {axes.right(), y}}, kGrid);
  }
}

void draw_axes(Canvas& canvas, const PanelPlace& place, double numbers_pt) {
  constexpr double kTitlePt = 7.5;
  draw_x_axis(canvas, place);
  draw_y_axis(canvas, place, numbers_pt);
  canvas.text(place.panel->title, {place.axes.x, place.axes.y - 2 * kTextGapPt}, kTitlePt, {0, 1});
}

void draw_colour_bar(Canvas& canvas, const Box& bar, const ColourScale& scale) {
  constexpr int kSteps = 64;
  const double step = bar.height / kSteps;
  for (int i = 0; i < kSteps; ++i) {
    const double share = 1 - (i + 0.5) / kSteps;
    // Down to the end, each over the one before: no seams.
    canvas.fill(Box{bar.x, bar.y + i * step, bar.width, bar.height - i * step},
                value_colour(share));
  }
  double numbers = 0;
  for (const Tick& tick : ticks_of(scale.values, kColourTicks)) {
    const double y = bar.y + (scale.values.high - tick.at) / scale.values.span() * bar.height;
    canvas.line(Points{{bar.right(), y}, {bar.right() + kTickPt, y}}, kAxis);
    canvas.text(tick.text, {bar.right() + kTickPt + kTextGapPt, y}, kTextPt, {0, 0.5});
    numbers = std::max(numbers, text_width_pt(tick.text, kTextPt));
  }
  const double label = bar.right() + kTickPt + 2 * kTextGapPt + numbers;
  canvas.text(scale.label, {label, bar.y + bar.height / 2}, kTextPt, {0.5, 0}, true);
}

}  // namespace stillpoint::figures
