// From where to where the axes of a panel reach.
#pragma once

#include "figures/canvas.hpp"
#include "figures/figure.hpp"

namespace stillpoint::figures {

/// Of axis 0 (x) or 1 (y): as the panel says, else what its marks need and a margin.
Range range_along(const Panel& panel, int axis);

/// Widens one of the two, so that a unit is as long along both.
void equalise(Range& x, Range& y, const Box& axes);

}  // namespace stillpoint::figures
