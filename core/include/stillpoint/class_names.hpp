// What class ids mean.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// Names by class id; id 0 is the background. Empty: no classes.
using ClassNames = std::vector<std::string>;

/// A list by name: `voc21` (PASCAL VOC), `coco80` (the background, then COCO in its usual order) or
/// `person` (background, person). Throws Error(kUsage) for another name.
STILLPOINT_EXPORT ClassNames named_classes(const std::string& list);

/// The classes that an option `classes` gives: the name of one list, or the class names
/// themselves, background first. Throws Error(kUsage) unless there are 2 to 256.
STILLPOINT_EXPORT ClassNames classes_of(const std::vector<std::string>& option);

/// The id of a class. Throws Error(kUsage) that suggests a name when there is none.
STILLPOINT_EXPORT int class_id(const ClassNames& classes, const std::string& name);

/// Red, green and blue of a class in pictures and maps: PASCAL VOC's, from the bits of its id.
STILLPOINT_EXPORT std::array<std::uint8_t, 3> color_of_class(std::uint8_t id);

}  // namespace stillpoint
