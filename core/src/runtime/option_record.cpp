#include "stillpoint/runtime/option_record.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

/// Whether YAML readers take the word for text without quotes.
bool is_plain_text(const std::string& text) {
  constexpr std::string_view kWords[] = {"null", "true", "false", "yes", "no", "on", "off"};
  const auto letter = [](unsigned char c) { return std::isalpha(c) || c == '/' || c == '_'; };
  std::string lower = text;
  std::ranges::transform(lower, lower.begin(), [](unsigned char c) { return std::tolower(c); });
  return !text.empty() && letter(text[0]) && std::ranges::find(kWords, lower) == std::end(kWords) &&
         std::ranges::all_of(text, [&](unsigned char c) {
           return letter(c) || std::isdigit(c) || c == '.' || c == '-';
         });
}

std::string quoted(const std::string& text) {
  std::string result = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') {
      result += {'\\', c};
    } else if (static_cast<unsigned char>(c) < 0x20) {
      char escape[8];
      std::snprintf(escape, sizeof(escape), "\\x%02X", static_cast<unsigned char>(c));
      result += escape;
    } else {
      result += c;
    }
  }
  return result + '"';
}

template <class T>
std::string flow_list(const std::vector<T>& values) {
  std::vector<std::string> texts;
  for (const T& value : values) texts.push_back(yaml_text(value));
  return "[" + join(texts) + "]";
}

void print_children(const OptionRecord& record, std::size_t indent, std::string& text);

void print_record(const OptionRecord& record, std::size_t indent, std::string& text) {
  const std::string comment = record.comment.empty() ? "" : "  # " + record.comment;
  text += yaml_text(record.name) + ":";
  if (record.kind == OptionRecord::Kind::kValue) {
    text += " " + record.value + comment + "\n";
  } else if (record.children.empty()) {
    text += (record.kind == OptionRecord::Kind::kList ? " []" : " {}") + comment + "\n";
  } else {
    text += comment + "\n";
    print_children(record, indent + 2, text);
  }
}

void print_children(const OptionRecord& record, std::size_t indent, std::string& text) {
  for (const OptionRecord& child : record.children) {
    if (record.kind == OptionRecord::Kind::kList) {
      std::string element;
      print_children(child, indent + 2, element);
      if (element.empty()) element = std::string(indent + 2, ' ') + "{}\n";
      element[indent] = '-';
      text += element;
    } else {
      text.append(indent, ' ');
      print_record(child, indent, text);
    }
  }
}

}  // namespace

std::string yaml_text(bool value) { return value ? "true" : "false"; }
std::string yaml_text(int value) { return std::to_string(value); }

std::string yaml_text(double value) {
  if (std::isnan(value)) return ".nan";
  if (std::isinf(value)) return value > 0 ? ".inf" : "-.inf";
  // Shortest would be 1e+05.
  if (value == std::trunc(value) && std::abs(value) < 1e9)
    return std::to_string(static_cast<long long>(value));
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof(buffer), value).ptr;
  return {buffer, end};
}

std::string yaml_text(const std::string& value) {
  return is_plain_text(value) ? value : quoted(value);
}
std::string yaml_text(const std::vector<double>& values) { return flow_list(values); }
std::string yaml_text(const std::vector<std::string>& values) { return flow_list(values); }

std::string range_text(const OptionInfo& info) {
  const bool low = std::isfinite(info.min), high = std::isfinite(info.max);
  if (low && high) return "[" + yaml_text(info.min) + ", " + yaml_text(info.max) + "]";
  if (low) return "at least " + yaml_text(info.min);
  if (high) return "at most " + yaml_text(info.max);
  return {};
}

std::string print_yaml(const OptionRecord& group) {
  std::string text;
  print_children(group, 0, text);
  return text;
}

}  // namespace stillpoint
