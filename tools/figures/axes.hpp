// Draws the axes of a panel: grid below its marks, lines, numbers and labels beside them.
#pragma once

#include "figures/layout.hpp"

namespace stillpoint::figures {

void draw_grid(Canvas& canvas, const PanelPlace& place);

/// `numbers_pt`: space between the axis' numbers and its label.
void draw_axes(Canvas& canvas, const PanelPlace& place, double numbers_pt);

void draw_colour_bar(Canvas& canvas, const Box& bar, const ColourScale& scale);

}  // namespace stillpoint::figures
