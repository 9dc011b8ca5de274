// stillpoint plugins: what is installed, the options of each type, and projects for new ones.
#include <algorithm>
#include <iomanip>
#include <iostream>
#include <memory>
#include <nlohmann/json.hpp>
#include <tuple>

#include "commands.hpp"
#include "stillpoint/runtime/option_describer.hpp"
#include "stillpoint/support/did_you_mean.hpp"

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
  const LateCalls late = watch_loading();
  Registry registry;
  for (const std::string& folder : first) registry.search(folder);
  for (const auto& folder : default_plugin_folders()) registry.search(folder);
  return registry;
}

struct ListOptions {
  bool json = false;
  bool strict = false;
};

std::vector<PluginType> sorted_types(const Registry& registry) {
  std::vector<PluginType> types = registry.types();
  std::ranges::stable_sort(types, {},
                           [](const PluginType& type) { return std::tie(type.kind, type.type); });
  return types;
}

void list_for_people(const Registry& registry) {
  std::vector<Row> rows = {{"KIND", "TYPE", "VERSION", "FILE"}};
  for (const PluginType& type : sorted_types(registry))
    rows.push_back({type.kind, type.type, type.version, type.library.string()});
  print_table(rows);
  if (!registry.unusable().empty()) std::cout << "\nnot usable:\n";
  for (const UnusableLibrary& library : registry.unusable())
    std::cout << "  " << library.library.string() << ": " << library.reason << '\n';
  if (!registry.missing_folders().empty()) std::cout << "\nfolders that are not there:\n";
  for (const auto& folder : registry.missing_folders())
    std::cout << "  " << folder.string() << '\n';
}

void list_as_json(const Registry& registry) {
  nlohmann::ordered_json types = nlohmann::json::array(), unusable = nlohmann::json::array(),
                         missing = nlohmann::json::array();
  for (const PluginType& type : sorted_types(registry))
    types.push_back({{"kind", type.kind},
                     {"type", type.type},
                     {"summary", type.summary},
                     {"plugin", type.plugin},
                     {"version", type.version},
                     {"library", type.library.string()}});
  for (const UnusableLibrary& library : registry.unusable())
    unusable.push_back({{"library", library.library.string()}, {"reason", library.reason}});
  for (const auto& folder : registry.missing_folders()) missing.push_back(folder.string());
  std::cout << nlohmann::ordered_json{{"types", types},
                                      {"unusable", unusable},
                                      {"missing_folders", missing}}
                   .dump(2)
            << '\n';
}

void list(const Registry& registry, const ListOptions& options) {
  options.json ? list_as_json(registry) : list_for_people(registry);
  if (options.strict && !(registry.unusable().empty() && registry.missing_folders().empty()))
    throw Error(Fault::kUsage, "not every plugin or folder can be used");
}

void describe(const PluginType& type) {
  std::cout << type.kind << ": {type: " << type.type << "}\n"
            << type.summary << "\nplugin " << type.plugin << ' ' << type.version << ", "
            << type.library.string() << "\n\n";
  OptionDescriber describer;
  describe_options(type, describer);
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
                "no plugin provides the type '" + name + "'" + did_you_mean(name, names), "",
                "'stillpoint plugins list' shows the types; 'plugins --path DIR describe TYPE' "
                "also looks into DIR");
}

}  // namespace

void add_plugins(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("plugins", "Show the plugins and their options; begin a new one");
  command->require_subcommand(1);
  auto folders = std::make_shared<std::vector<std::string>>();
  command->add_option("--path", *folders, "Folder to search first; may be repeated")
      ->type_name("DIR")
      ->allow_extra_args(false);

  CLI::App* list_command = command->add_subcommand(
      "list", "Every stage type with version and file, and what cannot be used");
  auto options = std::make_shared<ListOptions>();
  list_command->add_flag("--json", options->json, "Print JSON");
  list_command->add_flag("--strict", options->strict,
                         "Exit code 2 when a library, a type or a folder cannot be used");
  list_command->fallthrough();  // --path may stand behind it, too
  list_command->callback([folders, options] { list(search_plugins(*folders), *options); });

  CLI::App* describe_command =
      command->add_subcommand("describe", "The options of a type, as in 'describe octomap'");
  auto name = std::make_shared<std::string>();
  describe_command->add_option("type", *name, "TYPE, or KIND/TYPE when several kinds have the type")
      ->type_name("TYPE")
      ->required();
  describe_command->fallthrough();
  describe_command->callback([folders, name] { describe_all(search_plugins(*folders), *name); });

#ifdef STILLPOINT_ALL_COMMANDS
  add_plugins_check(*command);
#endif
  add_plugins_new(*command);
}

}  // namespace stillpoint
