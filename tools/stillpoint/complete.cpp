// stillpoint --complete WORD…: what the last word can become, for the scripts in completion/. One
// candidate per line, then a tab and its help. `<files>` and `<folders>` are the shell's own to
// list.
#include <algorithm>
#include <array>
#include <iostream>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/support/contract_list.hpp"

namespace stillpoint {
namespace {

struct Candidate {
  std::string word, help;
};

/// Where the words before the last one have led.
struct Place {
  const CLI::App* command;
  const CLI::Option* option = nullptr;  ///< whose value comes next, or null
  std::size_t positionals = 0;          ///< given already
};

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// Without those that --help does not list.
std::vector<const CLI::App*> subcommands(const CLI::App& command) {
  return command.get_subcommands([](const CLI::App* sub) { return !sub->get_group().empty(); });
}

Place follow(const CLI::App& app, const std::vector<std::string>& words) {
  Place place{&app};
  for (const std::string& word : words) {
    if (std::exchange(place.option, nullptr)) continue;  // its value
    if (word.starts_with('-')) {
      const CLI::Option* option = place.command->get_option_no_throw(word);
      if (option && takes_value(*option)) place.option = option;
      continue;
    }
    const auto subs = subcommands(*place.command);
    const auto sub = std::ranges::find(subs, word, [](auto* s) { return s->get_name(); });
    if (sub != subs.end())
      place = {*sub};
    else
      ++place.positionals;
  }
  return place;
}

std::vector<Candidate> options(const CLI::App& command) {
  std::vector<Candidate> all;
  for (const CLI::Option* option : command.get_options())
    for (const std::string& name : option->get_lnames())
      all.push_back({"--" + name, option->get_description()});
  return all;
}

/// What a value can be, by its name in the help, such as "DIR" or "color|class:{color,class}".
std::vector<Candidate> values(const std::string& name_in_help) {
  const std::string type = name_in_help.substr(0, name_in_help.find(':'));
  static constexpr std::array<std::pair<std::string_view, const char*>, 4> kConfigs = {
      {{"PIPELINE", "pipelines"},
       {"SCENE", "scenes"},
       {"STUDY", "studies"},
       {"CAMERA", "cameras"}}};
  std::vector<Candidate> all;
  for (const auto& [name, category] : kConfigs)
    if (type == name)
      for (const std::string& config : config_names(category)) all.push_back({config, ""});
  if (!all.empty() || type == "FILE" || type == "PATH") all.push_back({"<files>", ""});
  if (type == "DIR") all.push_back({"<folders>", ""});
  if (type == "KIND")
    for (const KindApi& contract : Contracts::kKinds)
      all.push_back({std::string(contract.kind), ""});
  if (type.find('|') != std::string::npos) {
    std::istringstream words(type);
    for (std::string word; std::getline(words, word, '|');) all.push_back({word, ""});
  }
  return all;
}

std::vector<Candidate> candidates(const Place& place, const std::string& begun) {
  if (place.option) return values(place.option->get_type_name());
  if (begun.starts_with('-')) return options(*place.command);
  std::vector<Candidate> all;
  for (const CLI::App* sub : subcommands(*place.command))
    all.push_back({sub->get_name(), sub->get_description()});
  const auto positionals = place.command->get_options(
      [](const CLI::Option* option) { return option->get_positional(); });
  if (place.positionals < positionals.size())
    for (Candidate& value : values(positionals[place.positionals]->get_type_name()))
      all.push_back(std::move(value));
  return all;
}

}  // namespace

void print_completions(const CLI::App& app, std::vector<std::string> words) {
  if (words.empty()) words.emplace_back();
  // "--camera=tum"
  if (const std::string last = words.back(); last.starts_with("--"))
    if (const std::size_t equals = last.find('='); equals != std::string::npos) {
      words.back() = last.substr(0, equals);
      words.push_back(last.substr(equals + 1));
    }
  const std::string begun = words.back();
  words.pop_back();
  for (const Candidate& candidate : candidates(follow(app, words), begun))
    if (candidate.word.starts_with(begun) || candidate.word.starts_with('<'))
      std::cout << candidate.word << '\t' << candidate.help << '\n';
}

}  // namespace stillpoint
