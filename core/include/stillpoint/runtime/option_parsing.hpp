// One value of an option from a configuration node: its type, range and choices.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stillpoint/options.hpp"
#include "stillpoint/runtime/config_node.hpp"

namespace stillpoint {

/// What is wrong with the value, to be read after the option's name: "= 3 is outside [8, 100]".
/// Empty: nothing, and the value has been stored.
using ValueFault = std::string;

ValueFault parse_value(const ConfigNode& node, const OptionInfo& info, bool& value);
ValueFault parse_value(const ConfigNode& node, const OptionInfo& info, int& value);
ValueFault parse_value(const ConfigNode& node, const OptionInfo& info, double& value);
/// Of a path, the absolute one.
ValueFault parse_value(const ConfigNode& node, const OptionInfo& info, std::string& value);
ValueFault parse_value(const ConfigNode& node, const OptionInfo& info, std::vector<double>& value);
ValueFault parse_value(const ConfigNode& node, const OptionInfo& info,
                       std::vector<std::string>& value);
ValueFault parse_choice(const ConfigNode& node, const std::vector<std::string_view>& choices,
                        std::string& value);

}  // namespace stillpoint
