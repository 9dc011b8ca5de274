// The page that `stillpoint evaluate --plot` and `stillpoint compare --plot` draw.
#pragma once

#include <span>

#include "evaluation/comparison.hpp"
#include "figures/figure.hpp"
#include "figures/trajectory_figure.hpp"

namespace stillpoint::figures {

/// Paths in the planes x–y and x–z and along each axis over time, and the absolute error over time,
/// as wide as the page. At least one run; all have the same reference.
Figure evaluation_figure(std::span<const evaluation::Contestant> runs);

}  // namespace stillpoint::figures
