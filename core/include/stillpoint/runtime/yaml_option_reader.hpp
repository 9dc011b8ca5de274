// Writes the values of a configuration section into the options that are visited, and finds what is
// wrong with the section.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "stillpoint/options.hpp"
#include "stillpoint/runtime/config_node.hpp"
#include "stillpoint/runtime/fault_list.hpp"
#include "stillpoint/runtime/option_record.hpp"

namespace stillpoint {

/// One reader reads one section: visit once, then call finish().
class STILLPOINT_EXPORT YamlOptionReader final : public OptionVisitor {
 public:
  /// `section` null: everything keeps its default. `path` names it in messages. A section that is
  /// not a map is a fault.
  YamlOptionReader(const ConfigNode* section, std::string path);

  /// A key that others read.
  void ignore(std::string_view key) { scopes_.front().known.emplace_back(key); }
  /// Adds unknown keys to the faults.
  void finish();

  const FaultList& faults() const { return faults_; }
  /// What was visited, with the values that hold now.
  const OptionRecord& record() const { return *record_; }

  void require(bool condition, std::string_view message) override;

 protected:
  void value(std::string_view name, bool& v, const OptionInfo& info) override;
  void value(std::string_view name, int& v, const OptionInfo& info) override;
  void value(std::string_view name, double& v, const OptionInfo& info) override;
  void value(std::string_view name, std::string& v, const OptionInfo& info,
             const std::vector<std::string_view>& choices) override;
  void value(std::string_view name, std::vector<double>& v, const OptionInfo& info) override;
  void value(std::string_view name, std::vector<std::string>& v, const OptionInfo& info) override;

  bool enter_group(std::string_view name, const OptionInfo& info) override;
  std::optional<std::size_t> enter_list(std::string_view name, std::size_t default_size,
                                        const OptionInfo& info) override;
  bool enter_element(std::size_t index) override;
  std::vector<std::string> enter_map(std::string_view name,
                                     const std::vector<std::string>& default_keys,
                                     const OptionInfo& info) override;
  void leave() override;

 private:
  /// A section, group or list being visited.
  struct Scope {
    const ConfigNode* node;  // null: not in the file
    std::string path;
    Location where;
    OptionRecord* record;
    std::vector<std::string> known;
    bool in_list;  // its fields have no defaults of their own: those hang on the default list
  };

  template <class T, class Parse>
  void read(std::string_view name, T& v, const OptionInfo& info, Parse parse);
  /// The node of an option, and a fault when it is required and missing.
  const ConfigNode* take(std::string_view name, const OptionInfo& info);
  void enter(const ConfigNode* node, std::string_view name, std::string path, OptionRecord record);
  void expect(const ConfigNode*& node, ConfigNode::Kind kind, const std::string& path);
  void report_unknown_keys();
  std::string path_of(std::string_view name) const;

  FaultList faults_;
  std::unique_ptr<OptionRecord> record_ = std::make_unique<OptionRecord>();
  std::vector<Scope> scopes_;
};

}  // namespace stillpoint
