// Ranges and conditions of options that no pipeline file was read into.
#pragma once

#include <string>
#include <utility>

#include "stillpoint/export.hpp"
#include "stillpoint/options.hpp"

namespace stillpoint {

/// Throws Error(kUsage) at the first value that is out of its range, not finite, or against a
/// condition. `what` begins the message: "camera 'mine'".
class STILLPOINT_EXPORT OptionCheck final : public OptionVisitor {
 public:
  explicit OptionCheck(std::string what) : what_(std::move(what)) {}

  void require(bool condition, std::string_view message) override;

 protected:
  void value(std::string_view, bool&, const OptionInfo&) override {}
  void value(std::string_view name, int& v, const OptionInfo& info) override;
  void value(std::string_view name, double& v, const OptionInfo& info) override;
  void value(std::string_view, std::string&, const OptionInfo&,
             const std::vector<std::string_view>&) override {}
  void value(std::string_view name, std::vector<double>& v, const OptionInfo& info) override;
  void value(std::string_view, std::vector<std::string>&, const OptionInfo&) override {}

  bool enter_group(std::string_view, const OptionInfo&) override { return true; }
  std::optional<std::size_t> enter_list(std::string_view, std::size_t, const OptionInfo&) override {
    return std::nullopt;
  }
  bool enter_element(std::size_t) override { return true; }
  std::vector<std::string> enter_map(std::string_view, const std::vector<std::string>& keys,
                                     const OptionInfo&) override {
    return keys;
  }
  void leave() override {}

 private:
  void check(std::string_view name, double value, const OptionInfo& info) const;

  std::string what_;
};

/// Checks a copy.
template <OptionGroup T>
void check_options(T options, const std::string& what) {
  OptionCheck check(what);
  options.visit(check);
}

}  // namespace stillpoint
