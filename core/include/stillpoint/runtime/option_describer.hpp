// The options of a stage as rows of a table.
#pragma once

#include <string>
#include <vector>

#include "stillpoint/options.hpp"

namespace stillpoint {

struct OptionRow {
  std::string name;  ///< "epsilon"; "classes.NAME.prior" in maps, "cameras[].fx" in lists
  std::string type;  ///< "number", "list of text", "wait | latest", …
  std::string default_value;
  std::string range;
  std::string unit;
  std::string help;
  bool is_path = false;
};

class STILLPOINT_EXPORT OptionDescriber final : public OptionVisitor {
 public:
  const std::vector<OptionRow>& rows() const { return rows_; }
  /// Mistakes of the plugin's author: names used twice, names that the runtime reads itself
  /// (`type`, `on_failure`, `when_full`), defaults outside their range.
  std::vector<std::string> faults() const;

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
  template <class T>
  void add_number(std::string_view name, std::string type, const T& v, const OptionInfo& info);
  template <class T>
  void add(std::string_view name, std::string type, const T& v, const OptionInfo& info);
  void enter(std::string_view name, std::string_view suffix, std::string_view type,
             const OptionInfo& info);

  std::vector<OptionRow> rows_;
  std::vector<std::string> bad_defaults_;
  std::vector<std::string> prefixes_ = {""};
};

}  // namespace stillpoint
