// From labels to the objects they form.
#pragma once

#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

/// Fills `objects` and `instances` with the connected parts of each class (8 neighbours), the
/// largest first, at most 255. What is smaller than `min_pixels` becomes background.
STILLPOINT_EXPORT void find_objects(Segmentation& segmentation, int min_pixels);

}  // namespace stillpoint
