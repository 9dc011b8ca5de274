// Options of a stage: one `visit()` per struct names every field once. The same function drives
// parsing, range checks, "did you mean", the effective file and the reference pages.
//
//   struct Options {
//     double epsilon = 1.0;
//     void visit(OptionVisitor& v) {
//       v("epsilon", epsilon, {.min = 0, .unit = "px", .help = "farther than this is moving"});
//     }
//   };
#pragma once

#include <cstddef>
#include <initializer_list>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// What a user can know about an option besides its name, type and default.
struct OptionInfo {
  double min = -std::numeric_limits<double>::infinity();  ///< smallest allowed number
  double max = std::numeric_limits<double>::infinity();   ///< largest allowed number
  std::string_view unit = {};                             ///< "px", "m", "s", "frames", …
  std::string_view help = {};                             ///< one line
  bool required = false;                                  ///< no default: leaving it out is a fault
  bool is_path = false;  ///< a relative path is meant from the folder of the file that names it
};

class OptionVisitor;

/// A struct whose fields are options.
template <class T>
concept OptionGroup = requires(T& group, OptionVisitor& visitor) {
  group.visit(visitor);
};

/// Called by `visit()` once per field, in the order in which the fields are documented.
/// A visitor may read the field, overwrite it, or both; it throws nothing for a user's mistakes but
/// collects them.
class STILLPOINT_EXPORT OptionVisitor {
 public:
  virtual ~OptionVisitor();

  void operator()(std::string_view name, bool& v, const OptionInfo& info) { value(name, v, info); }
  void operator()(std::string_view name, int& v, const OptionInfo& info) { value(name, v, info); }
  void operator()(std::string_view name, double& v, const OptionInfo& info) {
    value(name, v, info);
  }
  void operator()(std::string_view name, std::string& v, const OptionInfo& info) {
    value(name, v, info, {});
  }
  void operator()(std::string_view name, std::vector<double>& v, const OptionInfo& info) {
    value(name, v, info);
  }
  void operator()(std::string_view name, std::vector<std::string>& v, const OptionInfo& info) {
    value(name, v, info);
  }

  /// A nested struct: a YAML map of its own.
  template <OptionGroup T>
  void operator()(std::string_view name, T& group, const OptionInfo& info) {
    if (!enter_group(name, info)) return;
    group.visit(*this);
    leave();
  }

  /// A list of structs. Given in YAML, it replaces the default list.
  template <OptionGroup T>
  void operator()(std::string_view name, std::vector<T>& list, const OptionInfo& info) {
    if (const auto size = enter_list(name, list.size(), info)) list.assign(*size, T{});
    for (std::size_t i = 0; i < list.size(); ++i) {
      if (!enter_element(i)) continue;
      list[i].visit(*this);
      leave();
    }
    leave();
  }

  /// Structs by user-chosen key, `person: {prior: 0.9}`. Keys given in YAML join the defaults.
  template <OptionGroup T>
  void operator()(std::string_view name, std::map<std::string, T>& groups, const OptionInfo& info) {
    std::vector<std::string> keys;
    keys.reserve(groups.size());
    for (const auto& [key, group] : groups) keys.push_back(key);
    for (const std::string& key : enter_map(name, keys, info)) {
      if (!enter_group(key, {})) continue;
      groups[key].visit(*this);
      leave();
    }
    leave();
  }

  /// One of a few named values.
  template <class E>
  void choice(std::string_view name, E& v,
              std::initializer_list<std::pair<std::string_view, E>> choices,
              const OptionInfo& info) {
    std::string text;
    std::vector<std::string_view> names;
    for (const auto& [label, option] : choices) {
      names.push_back(label);
      if (option == v) text = label;
    }
    value(name, text, info, names);
    for (const auto& [label, option] : choices)
      if (label == text) v = option;
  }

  /// A condition over several fields; called after them. `message` completes "section: …".
  virtual void require(bool condition, std::string_view message);

 protected:
  virtual void value(std::string_view name, bool& v, const OptionInfo& info) = 0;
  virtual void value(std::string_view name, int& v, const OptionInfo& info) = 0;
  virtual void value(std::string_view name, double& v, const OptionInfo& info) = 0;
  /// `choices` empty: any text.
  virtual void value(std::string_view name, std::string& v, const OptionInfo& info,
                     const std::vector<std::string_view>& choices) = 0;
  virtual void value(std::string_view name, std::vector<double>& v, const OptionInfo& info) = 0;
  virtual void value(std::string_view name, std::vector<std::string>& v,
                     const OptionInfo& info) = 0;

  /// Returns whether to visit the group's fields; only then `leave()` follows.
  virtual bool enter_group(std::string_view name, const OptionInfo& info) = 0;
  /// Returns the number of new elements, or nothing to keep the default list; `leave()` always
  /// follows.
  virtual std::optional<std::size_t> enter_list(std::string_view name, std::size_t default_size,
                                                const OptionInfo& info) = 0;
  /// Like `enter_group`, for one element of the list entered last.
  virtual bool enter_element(std::size_t index) = 0;
  /// Returns the keys to visit, defaults included; `leave()` always follows.
  virtual std::vector<std::string> enter_map(std::string_view name,
                                             const std::vector<std::string>& default_keys,
                                             const OptionInfo& info) = 0;
  virtual void leave() = 0;
};

}  // namespace stillpoint
