#include "stillpoint/runtime/option_parsing.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "stillpoint/runtime/option_record.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

bool is_scalar(const ConfigNode& node) { return node.kind == ConfigNode::Kind::kScalar; }

/// The text as it was written where that is readable.
std::string shown(const std::string& scalar) {
  const bool readable = !scalar.empty() && std::ranges::none_of(scalar, [](unsigned char c) {
    return c <= ' ' || c == 0x7F;
  });
  return " = " + (readable ? scalar : yaml_text(scalar));
}

ValueFault wrong_type(const ConfigNode& node, const std::string& expected) {
  switch (node.kind) {
    case ConfigNode::Kind::kNull:
      return " has no value; expected " + expected;
    case ConfigNode::Kind::kScalar:
      return shown(node.scalar) + " is not " + expected;
    case ConfigNode::Kind::kList:
      return " is a list; expected " + expected;
    case ConfigNode::Kind::kMap:
      return " is a map; expected " + expected;
  }
  return {};
}

template <class T>
bool parse_all(std::string_view text, T& value) {
  if (text.starts_with('+')) text.remove_prefix(1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size();
}

ValueFault check_range(double value, const std::string& text, const OptionInfo& info) {
  if (value >= info.min && value <= info.max) return {};
  const bool both = std::isfinite(info.min) && std::isfinite(info.max);
  return " = " + text + (both ? " is outside " : " must be ") + range_text(info);
}

template <class T>
ValueFault parse_list(const ConfigNode& node, const OptionInfo& info, std::string_view example,
                      std::vector<T>& value) {
  if (node.kind != ConfigNode::Kind::kList)
    return wrong_type(node, "a list, as in " + std::string(example));
  std::vector<T> parsed(node.children.size());
  for (std::size_t i = 0; i < parsed.size(); ++i) {
    ValueFault fault = parse_value(node.children[i], info, parsed[i]);
    if (!fault.empty()) return "[" + std::to_string(i) + "]" + fault;
  }
  value = std::move(parsed);
  return {};
}

}  // namespace

ValueFault parse_value(const ConfigNode& node, const OptionInfo&, bool& value) {
  if (!is_scalar(node) || (node.scalar != "true" && node.scalar != "false"))
    return wrong_type(node, "true or false");
  value = node.scalar == "true";
  return {};
}

ValueFault parse_value(const ConfigNode& node, const OptionInfo& info, int& value) {
  int parsed = 0;
  if (!is_scalar(node) || !parse_all(node.scalar, parsed)) return wrong_type(node, "an integer");
  ValueFault fault = check_range(parsed, node.scalar, info);
  if (fault.empty()) value = parsed;
  return fault;
}

ValueFault parse_value(const ConfigNode& node, const OptionInfo& info, double& value) {
  double parsed = 0.0;
  if (!is_scalar(node) || !parse_all(node.scalar, parsed) || !std::isfinite(parsed))
    return wrong_type(node, "a number");
  ValueFault fault = check_range(parsed, node.scalar, info);
  if (fault.empty()) value = parsed;
  return fault;
}

ValueFault parse_value(const ConfigNode& node, const OptionInfo& info, std::string& value) {
  if (!is_scalar(node)) return wrong_type(node, info.is_path ? "a path" : "text");
  const bool resolve = info.is_path && !node.scalar.empty();
  value = resolve ? (node.folder / node.scalar).lexically_normal().string() : node.scalar;
  return {};
}

ValueFault parse_value(const ConfigNode& node, const OptionInfo& info, std::vector<double>& value) {
  return parse_list(node, info, "[0.5, 1]", value);
}

ValueFault parse_value(const ConfigNode& node, const OptionInfo& info,
                       std::vector<std::string>& value) {
  return parse_list(node, info, "[a, b]", value);
}

ValueFault parse_choice(const ConfigNode& node, const std::vector<std::string_view>& choices,
                        std::string& value) {
  const std::vector<std::string> names(choices.begin(), choices.end());
  if (!is_scalar(node)) return wrong_type(node, "one of " + join(names));
  for (const std::string& name : names) {
    if (name != node.scalar) continue;
    value = name;
    return {};
  }
  return shown(node.scalar) + " is not one of " + join(names) + did_you_mean(node.scalar, names);
}

}  // namespace stillpoint
