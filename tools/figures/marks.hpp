// Draws the marks of a panel, and what stands for them in the legend.
#pragma once

#include <optional>

#include "figures/layout.hpp"

namespace stillpoint::figures {

/// `colours`: of lines with values.
void draw_mark(Canvas& canvas, const PanelPlace& place, const std::optional<ColourScale>& colours,
               const Mark& mark);

/// At the middle of its left end, kSamplePt wide.
void draw_sample(Canvas& canvas, const Eigen::Vector2d& at, const Mark& mark);

}  // namespace stillpoint::figures
