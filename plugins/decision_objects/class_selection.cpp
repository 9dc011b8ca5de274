#include "decision_objects/class_selection.hpp"

#include <algorithm>

#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint::decision_objects {

int find_class(const ClassNames& classes, const std::string& name) {
  const auto found = std::ranges::find(classes, name);
  if (found != classes.end()) return static_cast<int>(found - classes.begin());
  ClassNames known = classes;
  for (const char* list : {"voc21", "coco80"})
    for (const std::string& other : named_classes(list)) known.push_back(other);
  if (std::ranges::find(known, name) != known.end()) return -1;
  throw Error(Fault::kUsage, "no class named '" + name + "'" + did_you_mean(name, known),
              "decision", "the segmenter has: " + join(classes));
}

std::bitset<256> select_classes(const ClassNames& classes, const std::vector<std::string>& names) {
  std::bitset<256> selected;
  for (const std::string& name : names)
    if (const int id = find_class(classes, name); id > 0)
      selected.set(static_cast<std::size_t>(id));
  if (selected.any()) return selected;
  if (classes.empty())
    throw Error(Fault::kUsage, "there is no segmenter, so nothing has a class", "decision",
                "add a segmenter section, or use geometry_only");
  throw Error(Fault::kUsage, "the segmenter knows none of: " + join(names), "decision",
              "it has: " + join(classes));
}

}  // namespace stillpoint::decision_objects
