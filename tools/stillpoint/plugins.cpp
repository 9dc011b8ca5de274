// stillpoint plugins: what is installed, and the options of each type.
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>

#include "commands.hpp"
#include "stillpoint/did_you_mean.hpp"
#include "stillpoint/runtime/option_describer.hpp"

namespace stillpoint {
namespace {

using Row = std::vector<std::string>;

/// Left-aligned columns as wide as their longest cell; the last one is left ragged.
void print_table(const std::vector<Row>& rows) {
  std::vector<std::size_t> widths;
  for (const Row& row : rows) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  for (const Row& row : rows) {
    for (std::size_t i = 0; i + 1 < row.size(); ++i)
      std::cout << std::left << std::setw(static_cast<int>(widths[i]) + 2) << row[i];
    std::cout << row.back() << '\n';
  }
}

Registry search_plugins(const std::vector<std::string>& first) {
  Registry registry;
  for (const std::string& folder : first) registry.search(folder);
  for (const auto& folder : default_plugin_folders()) registry.search(folder);
  return registry;
}

void list(const Registry& registry) {
  std::vector<PluginType> types = registry.types();
  std::ranges::stable_sort(types, {},
                           [](const PluginType& type) { return std::tie(type.kind, type.type); });
  std::vector<Row> rows = {{"KIND", "TYPE", "VERSION", "FILE"}};
  for (const PluginType& type : types)
    rows.push_back({type.kind, type.type, type.version, type.library.string()});
  print_table(rows);
  if (registry.unusable().empty()) return;
  std::cout << "\nnot usable:\n";
  for (const UnusableLibrary& library : registry.unusable())
    std::cout << "  " << library.library.string() << ": " << library.reason << '\n';
}

void describe(const PluginType& type) {
  std::cout << type.kind << ": {type: " << type.type << "}\n"
            << type.summary << "\nplugin " << type.plugin << ' ' << type.version << ", "
            << type.library.string() << "\n\n";
  OptionDescriber describer;
  type.entry->describe(describer);
  if (describer.rows().empty()) {
    std::cout << "no options\n";
    return;
  }
  std::vector<Row> rows = {{"OPTION", "TYPE", "DEFAULT", "RANGE", "UNIT", "MEANING"}};
  for (const OptionRow& row : describer.rows())
    rows.push_back({row.name, row.type, row.default_value, row.range, row.unit, row.help});
  print_table(rows);
}

/// Every kind that has the type: one name may stand for several stages, as `orb` does.
void describe_all(const Registry& registry, const std::string& name) {
  std::vector<std::string> names;
  bool found = false;
  for (const PluginType& type : registry.types()) {
    names.push_back(type.type);
    if (type.type != name && type.kind + "/" + type.type != name) continue;
    if (found) std::cout << '\n';
    found = true;
    describe(type);
  }
  if (!found)
    throw Error(Fault::kUsage,
                "no plugin provides the type '" + name + "'" + did_you_mean(name, names));
}

}  // namespace

void add_plugins(CLI::App& app) {
  CLI::App* command = app.add_subcommand("plugins", "Show the plugins and their options");
  command->require_subcommand(1);
  auto folders = std::make_shared<std::vector<std::string>>();
  command->add_option("--path", *folders, "Folder to search first; may be repeated")
      ->type_name("DIR")
      ->allow_extra_args(false);

  command->add_subcommand("list", "Every stage type with version and file, and unusable libraries")
      ->callback([folders] { list(search_plugins(*folders)); });

  CLI::App* describe_command =
      command->add_subcommand("describe", "The options of a type, as in 'describe octomap'");
  auto name = std::make_shared<std::string>();
  describe_command->add_option("type", *name, "TYPE, or KIND/TYPE for one of several stages")
      ->type_name("TYPE")
      ->required();
  describe_command->callback([folders, name] { describe_all(search_plugins(*folders), *name); });
}

}  // namespace stillpoint
