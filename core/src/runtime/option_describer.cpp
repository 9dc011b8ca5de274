#include "stillpoint/runtime/option_describer.hpp"

#include <set>

#include "stillpoint/runtime/option_record.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {

template <class T>
void OptionDescriber::add(std::string_view name, std::string type, const T& v,
                          const OptionInfo& info) {
  rows_.push_back({prefixes_.back() + std::string(name), std::move(type),
                   info.required ? "required" : yaml_text(v), range_text(info),
                   std::string(info.unit), std::string(info.help), info.is_path});
}

template <class T>
void OptionDescriber::add_number(std::string_view name, std::string type, const T& v,
                                 const OptionInfo& info) {
  add(name, std::move(type), v, info);
  if (info.required || (v >= info.min && v <= info.max)) return;
  bad_defaults_.push_back("the default of '" + rows_.back().name + "', " + yaml_text(v) +
                          ", is outside its range, " + range_text(info));
}

std::vector<std::string> OptionDescriber::faults() const {
  std::vector<std::string> faults = bad_defaults_;
  std::set<std::string> names;
  for (const OptionRow& row : rows_) {
    for (const char* reserved : {"type", "on_failure", "when_full"})
      if (row.name == reserved) faults.push_back("an option must not be named '" + row.name + "'");
    if (!names.insert(row.name).second)
      faults.push_back("two options are named '" + row.name + "'");
  }
  return faults;
}

void OptionDescriber::value(std::string_view name, bool& v, const OptionInfo& info) {
  add(name, "true | false", v, info);
}
void OptionDescriber::value(std::string_view name, int& v, const OptionInfo& info) {
  add_number(name, "integer", v, info);
}
void OptionDescriber::value(std::string_view name, double& v, const OptionInfo& info) {
  add_number(name, "number", v, info);
}
void OptionDescriber::value(std::string_view name, std::string& v, const OptionInfo& info,
                            const std::vector<std::string_view>& choices) {
  const std::string text = info.is_path ? "path" : "text";
  if (!choices.empty() && !info.required && std::ranges::find(choices, v) == choices.end())
    bad_defaults_.push_back("the default of '" + std::string(name) + "', '" + v +
                            "', is none of its choices");
  add(name, choices.empty() ? text : join({choices.begin(), choices.end()}, " | "), v, info);
}
void OptionDescriber::value(std::string_view name, std::vector<double>& v, const OptionInfo& info) {
  add(name, "list of numbers", v, info);
  if (!std::ranges::all_of(v, [&](double x) { return x >= info.min && x <= info.max; }))
    bad_defaults_.push_back("the default of '" + rows_.back().name +
                            "' has a number outside its range, " + range_text(info));
}
void OptionDescriber::value(std::string_view name, std::vector<std::string>& v,
                            const OptionInfo& info) {
  add(name, info.is_path ? "list of paths" : "list of text", v, info);
}

bool OptionDescriber::enter_group(std::string_view name, const OptionInfo& info) {
  enter(name, ".", "map", info);
  return true;
}

std::optional<std::size_t> OptionDescriber::enter_list(std::string_view name, std::size_t,
                                                       const OptionInfo& info) {
  enter(name, "[].", "list of maps", info);
  return 1;  // shows the fields of an element, also when the default list is empty
}

bool OptionDescriber::enter_element(std::size_t) {
  prefixes_.push_back(prefixes_.back());
  return true;
}

std::vector<std::string> OptionDescriber::enter_map(std::string_view name,
                                                    const std::vector<std::string>& default_keys,
                                                    const OptionInfo& info) {
  enter(name, ".", "map of maps", info);
  if (!default_keys.empty()) return default_keys;
  return {"NAME"};
}

void OptionDescriber::leave() { prefixes_.pop_back(); }

void OptionDescriber::enter(std::string_view name, std::string_view suffix, std::string_view type,
                            const OptionInfo& info) {
  const std::string path = prefixes_.back() + std::string(name);
  // The keys of a map have no help of their own; their fields do.
  if (!info.help.empty())
    rows_.push_back({.name = path,
                     .type = std::string(type),
                     .default_value = info.required ? "required" : "",
                     .range = "",
                     .unit = "",
                     .help = std::string(info.help)});
  prefixes_.push_back(path + std::string(suffix));
}

}  // namespace stillpoint
