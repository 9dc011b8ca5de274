#include "stillpoint/runtime/yaml_option_reader.hpp"

#include <algorithm>
#include <array>

#include "stillpoint/runtime/option_parsing.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

std::string comment_of(const OptionInfo& info, const std::string& default_value) {
  std::string text(info.help);
  if (!info.unit.empty()) text += (text.empty() ? "[" : " [") + std::string(info.unit) + "]";
  if (!default_value.empty()) text += (text.empty() ? "" : "; ") + ("default " + default_value);
  return text;
}

std::string not_a(ConfigNode::Kind kind, const ConfigNode& node) {
  if (node.kind == ConfigNode::Kind::kNull) return "has no value";
  return kind == ConfigNode::Kind::kMap ? "must be a map, as in {key: value}"
                                        : "must be a list, as in [{key: value}]";
}

}  // namespace

YamlOptionReader::YamlOptionReader(const ConfigNode* section, std::string path) {
  const Location where = section ? section->key_location : Location{};
  record_->kind = OptionRecord::Kind::kGroup;
  record_->name = path;
  if (section) expect(section, ConfigNode::Kind::kMap, path);
  scopes_.push_back({section, std::move(path), where, record_.get(), {}, false});
}

void YamlOptionReader::finish() { report_unknown_keys(); }

void YamlOptionReader::require(bool condition, std::string_view message) {
  const Scope& scope = scopes_.back();
  if (!condition) faults_.add(scope.where, scope.path + ": " + std::string(message));
}

template <class T, class Parse>
void YamlOptionReader::read(std::string_view name, T& v, const OptionInfo& info, Parse parse) {
  OptionRecord record{.name = std::string(name)};
  if (!info.required && !scopes_.back().in_list) record.default_value = yaml_text(v);
  record.comment = comment_of(info, record.default_value);
  if (const ConfigNode* node = take(name, info)) {
    const ValueFault fault = parse(*node);
    if (!fault.empty()) faults_.add(node->location, path_of(name) + fault);
  }
  record.value = yaml_text(v);
  scopes_.back().record->children.push_back(std::move(record));
}

void YamlOptionReader::value(std::string_view name, bool& v, const OptionInfo& info) {
  read(name, v, info, [&](const ConfigNode& node) { return parse_value(node, info, v); });
}
void YamlOptionReader::value(std::string_view name, int& v, const OptionInfo& info) {
  read(name, v, info, [&](const ConfigNode& node) { return parse_value(node, info, v); });
}
void YamlOptionReader::value(std::string_view name, double& v, const OptionInfo& info) {
  read(name, v, info, [&](const ConfigNode& node) { return parse_value(node, info, v); });
}
void YamlOptionReader::value(std::string_view name, std::string& v, const OptionInfo& info,
                             const std::vector<std::string_view>& choices) {
  if (choices.empty()) {
    read(name, v, info, [&](const ConfigNode& node) { return parse_value(node, info, v); });
    return;
  }
  const std::string names = join({choices.begin(), choices.end()}, " | ");
  OptionInfo documented = info;
  documented.unit = names;  // names stand where numbers have their unit
  read(name, v, documented, [&](const ConfigNode& node) { return parse_choice(node, choices, v); });
}
void YamlOptionReader::value(std::string_view name, std::vector<double>& v,
                             const OptionInfo& info) {
  read(name, v, info, [&](const ConfigNode& node) { return parse_value(node, info, v); });
}
void YamlOptionReader::value(std::string_view name, std::vector<std::string>& v,
                             const OptionInfo& info) {
  read(name, v, info, [&](const ConfigNode& node) { return parse_value(node, info, v); });
}

bool YamlOptionReader::enter_group(std::string_view name, const OptionInfo& info) {
  const ConfigNode* node = take(name, info);
  std::string path = path_of(name);
  if (node) expect(node, ConfigNode::Kind::kMap, path);
  enter(node, name, std::move(path),
        {.kind = OptionRecord::Kind::kGroup, .comment = comment_of(info, {})});
  return true;
}

std::optional<std::size_t> YamlOptionReader::enter_list(std::string_view name, std::size_t,
                                                        const OptionInfo& info) {
  const ConfigNode* node = take(name, info);
  std::string path = path_of(name);
  if (node) expect(node, ConfigNode::Kind::kList, path);
  enter(node, name, std::move(path),
        {.kind = OptionRecord::Kind::kList, .comment = comment_of(info, {})});
  if (!node) return std::nullopt;
  return node->children.size();
}

bool YamlOptionReader::enter_element(std::size_t index) {
  const Scope& list = scopes_.back();
  const ConfigNode* node = list.node ? &list.node->children[index] : nullptr;
  std::string path = list.path + "[" + std::to_string(index) + "]";
  if (node) expect(node, ConfigNode::Kind::kMap, path);
  enter(node, {}, std::move(path), {.kind = OptionRecord::Kind::kGroup});
  return true;
}

std::vector<std::string> YamlOptionReader::enter_map(std::string_view name,
                                                     const std::vector<std::string>& default_keys,
                                                     const OptionInfo& info) {
  enter_group(name, info);
  std::vector<std::string> keys = default_keys;
  if (const ConfigNode* node = scopes_.back().node)
    for (const ConfigNode& child : node->children)
      if (std::ranges::find(keys, child.key) == keys.end()) keys.push_back(child.key);
  return keys;
}

void YamlOptionReader::leave() {
  report_unknown_keys();
  scopes_.pop_back();
}

const ConfigNode* YamlOptionReader::take(std::string_view name, const OptionInfo& info) {
  Scope& scope = scopes_.back();
  scope.known.emplace_back(name);
  const ConfigNode* node = scope.node ? scope.node->find(name) : nullptr;
  if (!node && info.required && scope.node)
    faults_.add(scope.where, scope.path + ": '" + std::string(name) + "' is missing" +
                                 (info.help.empty() ? "" : " (" + std::string(info.help) + ")"));
  return node;
}

void YamlOptionReader::enter(const ConfigNode* node, std::string_view name, std::string path,
                             OptionRecord record) {
  Scope& scope = scopes_.back();
  record.name = name;
  scope.record->children.push_back(std::move(record));
  Location where = scope.where;
  if (node) where = node->key.empty() ? node->location : node->key_location;
  OptionRecord* entered = &scope.record->children.back();
  const bool in_list = scope.in_list || entered->kind == OptionRecord::Kind::kList;
  scopes_.push_back({node, std::move(path), std::move(where), entered, {}, in_list});
}

void YamlOptionReader::expect(const ConfigNode*& node, ConfigNode::Kind kind,
                              const std::string& path) {
  if (node->kind == kind) return;
  faults_.add(node->location, path + " " + not_a(kind, *node));
  node = nullptr;
}

namespace {

/// Keys of earlier versions, and what they are now.
constexpr std::array<std::array<const char*, 3>, 4> kRenamed = {{
    {"keyframe_max_frames", "keyframe_max_seconds", ", in seconds: 30 frames are 1"},
    {"interval", "interval_seconds", ", in seconds: 3 frames are 0.1"},
    {"latency", "latency_seconds", ", in seconds: 3 frames are 0.1"},
    {"without_motion", "empty_scene", ""},
}};

std::string renamed(const std::string& key, const std::vector<std::string>& known) {
  for (const auto& [earlier, now, unit] : kRenamed)
    if (key == earlier && std::ranges::find(known, now) != known.end())
      return std::string("; it is now '") + now + "'" + unit;
  return "";
}

}  // namespace

void YamlOptionReader::report_unknown_keys() {
  const Scope& scope = scopes_.back();
  if (!scope.node || scope.node->kind != ConfigNode::Kind::kMap) return;
  for (const ConfigNode& child : scope.node->children) {
    if (std::ranges::find(scope.known, child.key) != scope.known.end()) continue;
    std::string hint = renamed(child.key, scope.known);
    if (hint.empty()) hint = did_you_mean(child.key, scope.known);
    if (hint.empty()) hint = scope.known.empty() ? "" : "; known: " + join(scope.known);
    faults_.add(child.key_location, scope.path + ": unknown key '" + child.key + "'" + hint);
  }
}

std::string YamlOptionReader::path_of(std::string_view name) const {
  return scopes_.back().path + "." + std::string(name);
}

}  // namespace stillpoint
