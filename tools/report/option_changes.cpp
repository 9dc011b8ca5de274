#include "report/option_changes.hpp"

#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <utility>

#include "stillpoint/error.hpp"

namespace stillpoint::report {
namespace {

using Options = std::vector<std::pair<std::string, std::string>>;  // key, value

bool is_list_of_values(const YAML::Node& node) {
  return node.IsSequence() &&
         std::ranges::all_of(node, [](const YAML::Node& child) { return child.IsScalar(); });
}

std::string text_of_list(const YAML::Node& list) {
  std::string text;
  for (const YAML::Node& child : list) text += (text.empty() ? "" : ", ") + child.Scalar();
  return "[" + text + "]";
}

// Aliases of aliases can be more than any memory holds.
constexpr std::size_t kMostNodes = 20'000;

void collect(const YAML::Node& node, const std::string& key, Options& options, std::size_t& nodes) {
  if (++nodes > kMostNodes)
    throw Error(Fault::kData, "has more than 20,000 options", "pipeline.yaml");
  if (node.IsScalar()) {
    options.emplace_back(key, node.Scalar());
  } else if (is_list_of_values(node)) {
    options.emplace_back(key, text_of_list(node));
  } else if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i)
      collect(node[i], key + "[" + std::to_string(i) + "]", options, nodes);
  } else if (node.IsMap()) {
    for (const auto& child : node)
      collect(child.second, key.empty() ? child.first.Scalar() : key + "." + child.first.Scalar(),
              options, nodes);
  }
}

Options options_of(const std::string& yaml) {
  Options options;
  std::size_t nodes = 0;
  try {
    collect(YAML::Load(yaml), "", options, nodes);
  } catch (const YAML::Exception& error) {
    throw Error(Fault::kData, std::string("is no YAML: ") + error.what(), "pipeline.yaml");
  }
  std::erase_if(options, [](const auto& option) {
    return option.first == "source.path" || option.first == "runtime.seed";
  });
  return options;
}

const std::string* find(const Options& options, const std::string& key) {
  const auto found = std::ranges::find(options, key, &Options::value_type::first);
  return found == options.end() ? nullptr : &found->second;
}

}  // namespace

std::vector<OptionChange> option_changes(const std::string& base, const std::string& yaml) {
  const Options before = options_of(base), after = options_of(yaml);
  std::vector<OptionChange> changes;
  for (const auto& [key, value] : after) {
    const std::string* old = find(before, key);
    if (!old || *old != value) changes.push_back({key, old ? *old : "", value});
  }
  for (const auto& [key, value] : before)
    if (!find(after, key)) changes.push_back({key, value, ""});
  return changes;
}

std::string recording_of_pipeline(const std::string& yaml) {
  try {
    const YAML::Node source = YAML::Load(yaml)["source"];
    return source && source["path"] ? source["path"].Scalar() : "";
  } catch (const YAML::Exception&) {
    return "";
  }
}

std::string live_view_of_pipeline(const std::string& yaml) {
  try {
    for (const YAML::Node& output : YAML::Load(yaml)["outputs"])
      if (output["type"].Scalar() == "web" && output["record"]) return output["record"].Scalar();
    return "";
  } catch (const YAML::Exception&) {
    return "";
  }
}

}  // namespace stillpoint::report
