// What a visit of options saw: names, values and documentation as text.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "stillpoint/options.hpp"

namespace stillpoint {

struct OptionRecord {
  enum class Kind { kValue, kGroup, kList };

  std::string name;           ///< empty for elements of a list
  Kind kind = Kind::kValue;   ///< a map of groups is a kGroup
  std::string value;          ///< of a kValue, as YAML
  std::string default_value;  ///< of a kValue, as YAML; empty when there is none
  std::string comment;        ///< help, unit, default
  std::vector<OptionRecord> children;
};

/// Values as YAML that reads back as the same value.
std::string yaml_text(bool value);
std::string yaml_text(int value);
std::string yaml_text(double value);
std::string yaml_text(const std::string& value);
std::string yaml_text(const std::vector<double>& values);
std::string yaml_text(const std::vector<std::string>& values);

/// "[8, 100000]", "at least 8", "at most 1", or nothing.
std::string range_text(const OptionInfo& info);

/// The group as a YAML document, one line per option with its comment.
STILLPOINT_EXPORT std::string print_yaml(const OptionRecord& group);

}  // namespace stillpoint
