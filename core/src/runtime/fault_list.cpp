#include "stillpoint/runtime/fault_list.hpp"

#include <algorithm>
#include <tuple>

#include "stillpoint/engine/pipeline_config.hpp"
#include "stillpoint/support/did_you_mean.hpp"

namespace stillpoint {

void FaultList::add(const Location& where, const std::string& problem) {
  faults_.push_back({where, problem});
}

void FaultList::add(const FaultList& others) {
  faults_.insert(faults_.end(), others.faults_.begin(), others.faults_.end());
}

void FaultList::add_once(const Location& where, const std::string& problem) {
  if (std::ranges::find(faults_, problem, &Fault::problem) == faults_.end()) add(where, problem);
}

void FaultList::throw_if_any() const {
  if (faults_.empty()) return;
  std::vector<Fault> sorted = faults_;
  std::ranges::stable_sort(sorted, {}, [](const Fault& fault) {
    return std::tie(fault.where.file, fault.where.line, fault.where.column);
  });
  std::vector<std::string> lines;
  for (const Fault& fault : sorted)
    lines.push_back(fault.where.text() + ": error: " + fault.problem);
  lines.erase(std::unique(lines.begin(), lines.end()), lines.end());  // YAML aliases repeat nodes
  throw ConfigError(join(lines, "\n"));
}

}  // namespace stillpoint
