// A YAML document whose every node remembers where it was written, also after merging.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// Where something was written.
struct STILLPOINT_EXPORT Location {
  std::string file;  ///< or the words of the command line, such as "--set a=1"
  int line = 0;      ///< from 1; 0 on the command line
  int column = 0;    ///< from 1

  std::string text() const;
};

struct STILLPOINT_EXPORT ConfigNode {
  enum class Kind { kNull, kScalar, kList, kMap };

  Kind kind = Kind::kNull;
  std::string key;                   ///< in its map
  Location key_location;             ///< in its map
  std::string scalar;                ///< of a scalar
  std::vector<ConfigNode> children;  ///< of a list or map, in the order of the file
  Location location;                 ///< of the value
  std::filesystem::path folder;      ///< that relative paths are meant from
  bool replaces = false;             ///< what it is laid over, instead of merging with it

  /// The value of a key; null when it is not there.
  const ConfigNode* find(std::string_view name) const;
  ConfigNode* find(std::string_view name);
  /// Adds the node under its own key, or puts it in place of the one there.
  void set(ConfigNode node);
  void erase(std::string_view name);
};

ConfigNode empty_map(const Location& location);

/// Lays `overlay` over `base`: maps merge by key, everything else replaces.
ConfigNode merge(ConfigNode base, const ConfigNode& overlay);

/// The same for whole pipeline files: a stage section that names another `type`, or comes from a
/// file of its own, replaces the one below, because options of one mean nothing to the other.
STILLPOINT_EXPORT ConfigNode merge_sections(ConfigNode base, const ConfigNode& overlay);

/// A key without a value counts as left out.
STILLPOINT_EXPORT void remove_nulls(ConfigNode& node);

}  // namespace stillpoint
