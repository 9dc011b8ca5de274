// What a figure shows, as data: panels in rows, each with two axes and marks in their units.
// Lengths on the page are points (1/72 inch). figure_file.hpp draws it.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "figures/colour.hpp"
#include "figures/range.hpp"

namespace stillpoint::figures {

/// Widths of figures in a paper of two columns (IEEE: 3.5 and 7.16 inches).
inline constexpr double kColumnPt = 252, kPagePt = 516;

/// Line breaks at points that are not finite.
using Points = std::vector<Eigen::Vector2d>;

/// Marks with a name stand in the legend of the figure, once for each name.
struct Line {
  std::string name;
  Points points;
  Colour colour = kInk;
  double width_pt = 1.0;
  bool dashed = false;
  bool filled = false;  ///< down to 0, translucent
};

/// A line with the colours of its values on the figure's colour scale.
struct ValueLine {
  Points points;
  std::vector<double> values;  ///< one for each point
  double width_pt = 1.5;
};

struct Dot {
  std::string name;
  Eigen::Vector2d at;
  Colour colour = kInk;
  double radius_pt = 2.0;
};

/// A stretch of x, over the whole height or, with a lane, as a narrow strip at the top, that of
/// lane 0 uppermost. Without length it is a thin line.
struct Stretch {
  std::string name;
  Range x;
  Colour colour = kReferenceGrey;
  std::optional<int> lane;
};

/// A box along x, `thickness` high (of the y axis' units) around y.
struct Bar {
  std::string name;
  Range x;
  double y = 0;
  double thickness = 0.6;
  Colour colour = kInk;
};

/// In the order in which they are drawn.
using Mark = std::variant<Line, ValueLine, Dot, Stretch, Bar>;

struct Axis {
  std::string label;                ///< with the unit
  std::optional<double> low, high;  ///< its ends; without, what the marks need and a margin
  bool numbers = true;
  /// Names at 0, 1, 2, … instead of numbers; as the y axis from top to bottom.
  std::vector<std::string> categories;
};

struct Panel {
  std::string title;
  Axis x, y;
  std::vector<Mark> marks;
  bool equal_scale = false;  ///< a unit is as long along x as along y
};

struct Row {
  double height_pt = 90;  ///< of the axes, without their labels
  std::vector<Panel> panels;
};

struct ColourScale {
  std::string label;  ///< with the unit
  Range values{0, 1};
};

struct Figure {
  std::string title;  ///< for programs that list or read out files; a paper has its caption
  double width_pt = kColumnPt;
  std::vector<Row> rows;
  std::optional<ColourScale> colour_scale;  ///< drawn beside the first row
};

}  // namespace stillpoint::figures
