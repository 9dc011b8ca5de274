// Classes by name, as pipeline files give them.
#pragma once

#include <bitset>
#include <map>
#include <string>
#include <vector>

#include "stillpoint/class_names.hpp"

namespace stillpoint::decision_objects {

/// The id of a class, or -1 when this segmenter does not know it but others do: so that a
/// pipeline works with another network. Throws Error(kUsage) for a name that is in no list.
int find_class(const ClassNames& classes, const std::string& name);

/// Ids of the listed classes. Throws Error(kUsage) when the segmenter knows none of them.
std::bitset<256> select_classes(const ClassNames& classes, const std::vector<std::string>& names);

}  // namespace stillpoint::decision_objects
