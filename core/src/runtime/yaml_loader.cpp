#include "stillpoint/runtime/yaml_loader.hpp"

#include <yaml-cpp/depthguard.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <utility>
#include <vector>

#include "stillpoint/engine/config_lookup.hpp"
#include "stillpoint/error.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {
namespace {

namespace fs = std::filesystem;

// Aliases can nest a node in itself, or double a document at every level.
constexpr int kMaxDepth = 32;
constexpr int kMaxNodes = 10000;  // keys are compared with each other
constexpr std::uintmax_t kMaxBytes = 1 << 20;
constexpr std::size_t kMaxFiles = 32;  // that extend each other

constexpr const char* kTooLarge = "nested too deeply or too large for a configuration";

/// Turns the nodes of one document into ours.
class Converter {
 public:
  Converter(Location origin, fs::path folder, FaultList& faults)
      : origin_(std::move(origin)), folder_(std::move(folder)), faults_(faults) {}

  ConfigNode convert(const YAML::Node& yaml, const std::string& path = {}, int depth = 0) {
    ConfigNode node;
    node.location = at(yaml.Mark());
    node.folder = folder_;
    if (depth > kMaxDepth || ++nodes_ > kMaxNodes) {
      if (!std::exchange(too_large_, true)) faults_.add(node.location, kTooLarge);
      return node;
    }
    if (yaml.IsScalar()) {
      node.kind = ConfigNode::Kind::kScalar;
      node.scalar = yaml.Scalar();
    } else if (yaml.IsSequence()) {
      node.kind = ConfigNode::Kind::kList;
      for (const auto& item : yaml)
        node.children.push_back(
            convert(item, path + "[" + std::to_string(node.children.size()) + "]", depth + 1));
    } else if (yaml.IsMap()) {
      node.kind = ConfigNode::Kind::kMap;
      for (const auto& pair : yaml) add_pair(node, pair.first, pair.second, path, depth);
    }
    return node;
  }

  bool too_large() const { return too_large_; }

 private:
  void add_pair(ConfigNode& map, const YAML::Node& yaml_key, const YAML::Node& yaml_value,
                const std::string& path, int depth) {
    if (too_large_) return;
    const Location where = at(yaml_key.Mark());
    const std::string prefix = path.empty() ? "" : path + ": ";
    if (!yaml_key.IsScalar()) {
      faults_.add(where, prefix + "a key must be a name");
      return;
    }
    const std::string& key = yaml_key.Scalar();
    if (map.find(key)) {
      faults_.add(where, prefix + "key '" + key + "' is given twice");
      return;
    }
    ConfigNode value = convert(yaml_value, path.empty() ? key : path + "." + key, depth + 1);
    value.key = key;
    value.key_location = where;
    map.children.push_back(std::move(value));
  }

  Location at(const YAML::Mark& mark) const {
    Location where = origin_;
    if (where.line > 0) {
      where.line = mark.line + 1;
      where.column = mark.column + 1;
    }
    return where;
  }

  Location origin_;
  fs::path folder_;
  FaultList& faults_;
  int nodes_ = 0;
  bool too_large_ = false;
};

/// Where documents begin.
class DocumentStarts final : public YAML::EventHandler {
 public:
  void OnDocumentStart(const YAML::Mark& mark) override { marks.push_back(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}

  std::vector<YAML::Mark> marks;
};

enum class Documents { kNone, kOne, kSeveral };

/// Throws YAML::ParserException for what is no YAML, also for a text on which YAML::LoadAll never
/// ends, such as ", a": the parser takes it for one empty document after the other.
Documents documents_in(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  DocumentStarts starts;
  if (!parser.HandleNextDocument(starts)) return Documents::kNone;
  if (!parser.HandleNextDocument(starts)) return Documents::kOne;
  if (starts.marks[0].pos == starts.marks[1].pos)
    throw YAML::ParserException(starts.marks[0], "a value is missing");
  return Documents::kSeveral;
}

/// One document; nothing when it is no YAML or too large, which is added as a fault.
std::optional<ConfigNode> parse(const std::string& text, Location origin, const fs::path& folder,
                                FaultList& faults) {
  try {
    switch (documents_in(text)) {
      case Documents::kNone:
        return ConfigNode();
      case Documents::kOne: {
        Converter converter(origin, folder, faults);
        ConfigNode node = converter.convert(YAML::Load(text));
        if (converter.too_large()) return std::nullopt;
        return node;
      }
      case Documents::kSeveral:
        break;
    }
    faults.add(origin, "more than one YAML document ('---') in a file");
    return std::nullopt;
  } catch (const YAML::DeepRecursion&) {
    faults.add(origin, kTooLarge);
    return std::nullopt;
  } catch (const YAML::Exception& error) {
    if (origin.line > 0 && !error.mark.is_null())
      origin = {origin.file, error.mark.line + 1, error.mark.column + 1};
    faults.add(origin, "not valid YAML: " + error.msg);
    return std::nullopt;
  }
}

std::optional<std::string> read_text(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  std::ifstream stream(file, std::ios::binary);
  if (!stream) return std::nullopt;
  std::string text(std::min(fs::file_size(file, error), kMaxBytes + 1), '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return text;
}

Location start_of(const fs::path& file) { return {file.string(), 1, 1}; }

using Prepare = std::function<void(ConfigNode&)>;

/// How the files of a chain are read.
struct Chain {
  const std::string& category;
  const Prepare& prepare;
  FaultList& faults;
  ConfigFiles& files;
};

ConfigNode load_chain(const fs::path& file, const Location& named_at, std::vector<fs::path> above,
                      const Chain& chain);

/// Takes `extends` out of a file and loads what it names.
std::optional<ConfigNode> load_parent(ConfigNode& node, const fs::path& file,
                                      const std::vector<fs::path>& above, const Chain& chain) {
  ConfigNode* extends = node.find("extends");
  if (!extends) return std::nullopt;
  substitute_environment(*extends, chain.faults);
  const ConfigNode named = *extends;
  node.erase("extends");
  if (named.kind != ConfigNode::Kind::kScalar || named.scalar.empty()) {
    chain.faults.add(named.key_location, "extends takes the path or the name of one file");
    return std::nullopt;
  }
  try {
    const fs::path parent = find_config(named.scalar, chain.category, file.parent_path());
    return load_chain(parent, named.location, above, chain);
  } catch (const Error& fault) {
    chain.faults.add(named.location, std::string("extends: ") + fault.what());
    return std::nullopt;
  }
}

ConfigNode load_chain(const fs::path& file, const Location& named_at, std::vector<fs::path> above,
                      const Chain& chain) {
  FaultList& faults = chain.faults;
  std::error_code unreadable;  // said below
  const fs::path identity = fs::weakly_canonical(file, unreadable);
  if (std::ranges::find(above, identity) != above.end()) {
    faults.add(named_at, "extends goes in a circle: '" + file.string() + "' is already being read");
    return empty_map(start_of(file));
  }
  above.push_back(identity);
  if (above.size() > kMaxFiles) {
    faults.add(named_at, "extends goes on over more than " + std::to_string(kMaxFiles) + " files");
    return empty_map(start_of(file));
  }
  std::optional<ConfigNode> node = chain.files.load(file, named_at, faults);
  if (!node) return empty_map(start_of(file));
  const auto parent = load_parent(*node, file, above, chain);
  if (chain.prepare) chain.prepare(*node);
  return parent ? merge_sections(*parent, *node) : *node;
}

bool is_variable_name(std::string_view name) {
  const auto letter = [](char c) {
    return c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
  };
  return !name.empty() && letter(name[0]) &&
         std::ranges::all_of(name, [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

std::string substituted(const std::string& text, const Location& where, FaultList& faults) {
  std::string result;
  std::size_t position = 0;
  for (;;) {
    const std::size_t start = text.find("${", position);
    result.append(text, position, start - position);
    if (start == std::string::npos) return result;
    const std::size_t end = text.find('}', start);
    const std::string name = text.substr(start + 2, end - start - 2);
    if (end == std::string::npos || !is_variable_name(name)) {
      faults.add(where,
                 "'" + text + "': expected the name of an environment variable, as in ${HOME}");
      return result;
    }
    if (const char* value = std::getenv(name.c_str()))
      result += value;
    else
      faults.add_once(where, "environment variable '" + name +
                                 "' is not set; set it, or write a value in its place");
    position = end + 1;
  }
}

}  // namespace

std::optional<ConfigNode> ConfigFiles::load(const fs::path& file, const Location& named_at,
                                            FaultList& faults) {
  if (const auto known = loaded_.find(file); known != loaded_.end()) return known->second;
  const std::optional<std::string> text = read_text(file);
  if (!text) {
    faults.add(named_at, "cannot read '" + file.string() + "'");
    return std::nullopt;
  }
  if (text->size() > kMaxBytes) {
    faults.add(start_of(file), "is larger than 1 MiB: no configuration");
    return std::nullopt;
  }
  FaultList found;
  std::optional<ConfigNode> node =
      parse(*text, start_of(file), fs::absolute(file).parent_path(), found);
  if (node && node->kind != ConfigNode::Kind::kMap) {
    found.add(start_of(file), "expected sections, as in 'source: {type: tum_rgbd}'");
    node.reset();
  }
  faults.add(found);
  if (node && found.empty()) loaded_.emplace(file, *node);  // or the faults were told once only
  return node;
}

ConfigNode load_config_file(const fs::path& file, const std::string& category, FaultList& faults,
                            const Prepare& prepare) {
  ConfigFiles files;
  return load_config_file(file, category, faults, prepare, files);
}

ConfigNode load_config_file(const fs::path& file, const std::string& category, FaultList& faults,
                            const Prepare& prepare, ConfigFiles& files) {
  return load_chain(file, start_of(file), {}, {category, prepare, faults, files});
}

ConfigNode parse_assignment(const std::string& assignment, FaultList& faults,
                            const std::string& option) {
  const Location where{option + ' ' + assignment};
  const ConfigNode nothing = empty_map(where);
  const std::size_t equals = assignment.find('=');
  const std::string path = assignment.substr(0, equals);
  if (equals == std::string::npos || path.empty() || path.front() == '.' || path.back() == '.' ||
      path.find("..") != std::string::npos) {
    faults.add(where, "expected KEY.SUB=VALUE, as in tracker.features=2000");
    return nothing;
  }
  if (std::ranges::count(path, '.') > kMaxDepth) {
    faults.add({option}, kTooLarge);
    return nothing;
  }
  auto node = parse(assignment.substr(equals + 1), where, fs::current_path(), faults);
  if (!node) return nothing;
  for (std::size_t end = path.size(); end != std::string::npos;) {
    const std::size_t dot = end == 0 ? std::string::npos : path.rfind('.', end - 1);
    const std::size_t start = dot == std::string::npos ? 0 : dot + 1;
    node->key = path.substr(start, end - start);
    node->key_location = where;
    ConfigNode map = nothing;
    map.children.push_back(*std::move(node));
    node = std::move(map);
    end = dot;
  }
  return *std::move(node);
}

void substitute_environment(ConfigNode& node, FaultList& faults) {
  if (node.kind == ConfigNode::Kind::kScalar)
    node.scalar = substituted(node.scalar, node.location, faults);
  for (ConfigNode& child : node.children) substitute_environment(child, faults);
}

}  // namespace stillpoint
