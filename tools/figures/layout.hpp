// Where the parts of a figure lie on its page. Points, y down.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "figures/canvas.hpp"
#include "figures/figure.hpp"

namespace stillpoint::figures {

inline constexpr double kTextPt = 7, kTickPt = 2.5, kTextGapPt = 2.5;

/// Axes on the page, and what numbers they reach from and to. Categories begin at the top: their
/// range falls.
struct PanelPlace {
  const Panel* panel;
  Box axes;
  Range x, y;

  Eigen::Vector2d on_page(const Eigen::Vector2d& point) const;
  std::vector<Tick> x_ticks() const, y_ticks() const;
};

struct LegendPlace {
  const Mark* mark;
  std::string text;    ///< its name, shortened where it is wider than the figure
  Eigen::Vector2d at;  ///< left end of the sample, in its middle
};
inline constexpr double kSamplePt = 14;

/// About so many numbers stand beside the colour bar.
inline constexpr double kColourTicks = 5;

struct Layout {
  double width_pt, height_pt;
  std::vector<LegendPlace> legend;
  std::vector<PanelPlace> panels;
  double numbers_pt;  ///< width of the widest number left of the axes
  std::optional<Box> colour_bar;
};

/// Points into the figure.
Layout lay_out(const Figure& figure);

/// Of any kind of mark; nothing where there is none.
std::string name_of(const Mark& mark);

}  // namespace stillpoint::figures
