#include "stillpoint/runtime/config_node.hpp"

#include <algorithm>
#include <utility>

namespace stillpoint {
namespace {

bool is_another(const ConfigNode& base, const ConfigNode& overlay) {
  if (overlay.replaces) return true;
  const ConfigNode* old_type = base.find("type");
  const ConfigNode* new_type = overlay.find("type");
  return old_type && new_type && old_type->scalar != new_type->scalar;
}

template <class MergeChild>
ConfigNode merge_children(ConfigNode base, const ConfigNode& overlay, MergeChild merge_child) {
  if (base.kind != ConfigNode::Kind::kMap || overlay.kind != ConfigNode::Kind::kMap) return overlay;
  for (const ConfigNode& child : overlay.children) {
    const ConfigNode* existing = base.find(child.key);
    base.set(existing ? merge_child(*existing, child) : child);
  }
  // The command line has no line to point at.
  if (overlay.location.line > 0) {
    base.location = overlay.location;
    base.key_location = overlay.key_location;
  }
  return base;
}

}  // namespace

std::string Location::text() const {
  if (line == 0) return file;
  return file + ":" + std::to_string(line) + ":" + std::to_string(column);
}

const ConfigNode* ConfigNode::find(std::string_view name) const {
  if (kind != Kind::kMap) return nullptr;
  const auto found = std::ranges::find(children, name, &ConfigNode::key);
  return found == children.end() ? nullptr : &*found;
}

ConfigNode* ConfigNode::find(std::string_view name) {
  return const_cast<ConfigNode*>(std::as_const(*this).find(name));
}

void ConfigNode::set(ConfigNode node) {
  if (ConfigNode* existing = find(node.key))
    *existing = std::move(node);
  else
    children.push_back(std::move(node));
}

void ConfigNode::erase(std::string_view name) {
  std::erase_if(children, [&](const ConfigNode& child) { return child.key == name; });
}

ConfigNode empty_map(const Location& location) {
  ConfigNode node;
  node.kind = ConfigNode::Kind::kMap;
  node.location = location;
  return node;
}

ConfigNode merge(ConfigNode base, const ConfigNode& overlay) {
  return merge_children(std::move(base), overlay, merge);
}

ConfigNode merge_sections(ConfigNode base, const ConfigNode& overlay) {
  return merge_children(std::move(base), overlay,
                        [](const ConfigNode& section, const ConfigNode& change) {
                          return is_another(section, change) ? change : merge(section, change);
                        });
}

void remove_nulls(ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::kMap)
    std::erase_if(node.children,
                  [](const ConfigNode& child) { return child.kind == ConfigNode::Kind::kNull; });
  for (ConfigNode& child : node.children) remove_nulls(child);
}

}  // namespace stillpoint
