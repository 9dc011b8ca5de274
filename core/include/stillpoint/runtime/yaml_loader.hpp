// From YAML text to ConfigNode: syntax, duplicate keys, `extends`, `--set` and `${NAME}`.
#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>

#include "stillpoint/export.hpp"
#include "stillpoint/runtime/config_node.hpp"
#include "stillpoint/runtime/fault_list.hpp"

namespace stillpoint {

/// Configuration files, each read and parsed once: many pipelines extend the same few. They must
/// not change meanwhile. For one thread.
class STILLPOINT_EXPORT ConfigFiles {
 public:
  /// The file's own map; nothing when it cannot be read or parsed, which is added as a fault.
  /// `named_at` is where a file says its name.
  std::optional<ConfigNode> load(const std::filesystem::path& file, const Location& named_at,
                                 FaultList& faults);

 private:
  std::map<std::filesystem::path, ConfigNode> loaded_;
};

/// A file with everything it extends merged below it. `extends` takes a path from that file, or a
/// name of `category`, see find_config. An empty map when a file cannot be read or parsed, which is
/// a fault then. `prepare` is called with each file's own text before merging.
STILLPOINT_EXPORT ConfigNode load_config_file(const std::filesystem::path& file,
                                              const std::string& category, FaultList& faults,
                                              const std::function<void(ConfigNode&)>& prepare = {});
STILLPOINT_EXPORT ConfigNode load_config_file(const std::filesystem::path& file,
                                              const std::string& category, FaultList& faults,
                                              const std::function<void(ConfigNode&)>& prepare,
                                              ConfigFiles& files);

/// The map for `key.sub=value`; relative paths are meant from the working folder. Messages call it
/// `option assignment`.
STILLPOINT_EXPORT ConfigNode parse_assignment(const std::string& assignment, FaultList& faults,
                                              const std::string& option = "--set");

/// Replaces ${NAME} in every scalar by the environment variable.
STILLPOINT_EXPORT void substitute_environment(ConfigNode& node, FaultList& faults);

}  // namespace stillpoint
