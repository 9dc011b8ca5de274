// From labels to the objects they form.
#pragma once

#include <cstddef>

#include "stillpoint/contracts/segmentation.hpp"
#include "stillpoint/export.hpp"

namespace stillpoint {

inline constexpr std::size_t kMostObjects = 255;  // of an image: instances are 8-bit

/// Fills `objects` and `instances` with the connected parts of each class (8 neighbours), the
/// largest first, at most kMostObjects. What is smaller than `min_pixels` becomes background.
STILLPOINT_EXPORT void find_objects(Segmentation& segmentation, int min_pixels);

}  // namespace stillpoint
