#include "study_grid.hpp"

#include <string>
#include <utility>
#include <vector>

namespace stillpoint {
namespace {

using Kind = ConfigNode::Kind;

constexpr std::size_t kMostVariants = 10'000;  // of one grid

std::string last_word(const std::string& key) { return key.substr(key.rfind('.') + 1); }

bool is_axis(const ConfigNode& axis, FaultList& faults) {
  if (axis.kind != Kind::kList || axis.children.empty()) {
    faults.add(axis.location, "'" + axis.key + "' of a grid needs its values, as in [500, 1000]");
    return false;
  }
  for (const ConfigNode& value : axis.children)
    if (value.kind != Kind::kScalar && value.kind != Kind::kNull) {
      faults.add(value.location, "a value of a grid is a number, a word or null");
      return false;
    }
  return true;
}

ConfigNode with_value(ConfigNode variant, const ConfigNode& axis, const ConfigNode& value) {
  const std::string text = value.kind == Kind::kNull ? "null" : value.scalar;
  ConfigNode assignment = value;
  assignment.key.clear();
  assignment.kind = Kind::kScalar;
  assignment.scalar = axis.key + "=" + text;
  if (ConfigNode* set = variant.find("set")) {
    set->children.push_back(std::move(assignment));
  } else {
    ConfigNode list;
    list.kind = Kind::kList;
    list.key = "set";
    list.key_location = axis.key_location;
    list.location = axis.location;
    list.folder = axis.folder;
    list.children.push_back(std::move(assignment));
    variant.set(std::move(list));
  }
  if (ConfigNode* name = variant.find("name"))
    name->scalar += "-" + last_word(axis.key) + "-" + text;
  return variant;
}

/// One for each combination; none after a fault.
std::vector<ConfigNode> expanded(ConfigNode variant, FaultList& faults) {
  const ConfigNode grid = *variant.find("grid");
  variant.erase("grid");
  if (grid.kind != Kind::kMap || grid.children.empty()) {
    faults.add(grid.location, "a grid is written {OPTION: [VALUE, VALUE]}");
    return {};
  }
  std::vector<ConfigNode> variants = {std::move(variant)};
  for (const ConfigNode& axis : grid.children) {
    if (!is_axis(axis, faults)) return {};
    if (variants.size() * axis.children.size() > kMostVariants) {
      faults.add(grid.location, "this grid has more than 10000 variants");
      return {};
    }
    std::vector<ConfigNode> more;
    for (const ConfigNode& one : variants)
      for (const ConfigNode& value : axis.children) more.push_back(with_value(one, axis, value));
    variants = std::move(more);
  }
  return variants;
}

}  // namespace

void expand_grids(ConfigNode& study, FaultList& faults) {
  ConfigNode* list = study.find("variants");
  if (!list || list->kind != Kind::kList) return;
  std::vector<ConfigNode> variants;
  for (ConfigNode& variant : list->children) {
    if (variant.kind == Kind::kMap && variant.find("grid"))
      for (ConfigNode& one : expanded(std::move(variant), faults))
        variants.push_back(std::move(one));
    else
      variants.push_back(std::move(variant));
  }
  list->children = std::move(variants);
}

}  // namespace stillpoint
