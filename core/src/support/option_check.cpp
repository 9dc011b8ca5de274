#include "stillpoint/support/option_check.hpp"

#include <cmath>
#include <sstream>

#include "stillpoint/error.hpp"

namespace stillpoint {

void OptionCheck::require(bool condition, std::string_view message) {
  if (!condition) throw Error(Fault::kUsage, std::string(message), what_);
}

void OptionCheck::value(std::string_view name, int& v, const OptionInfo& info) {
  check(name, v, info);
}
void OptionCheck::value(std::string_view name, double& v, const OptionInfo& info) {
  check(name, v, info);
}
void OptionCheck::value(std::string_view name, std::vector<double>& v, const OptionInfo& info) {
  for (const double element : v) check(name, element, info);
}

void OptionCheck::check(std::string_view name, double value, const OptionInfo& info) const {
  if (std::isfinite(value) && value >= info.min && value <= info.max) return;
  std::ostringstream text;
  text << name << " = " << value << " is not ";
  if (!std::isfinite(value))
    text << "finite";
  else if (value < info.min)
    text << "at least " << info.min;
  else
    text << "at most " << info.max;
  throw Error(Fault::kUsage, text.str(), what_);
}

}  // namespace stillpoint
