// Collects what is wrong with a configuration, so that a user sees all of it at once.
#pragma once

#include <string>
#include <vector>

#include "stillpoint/export.hpp"
#include "stillpoint/runtime/config_node.hpp"

namespace stillpoint {

class STILLPOINT_EXPORT FaultList {
 public:
  void add(const Location& where, const std::string& problem);
  void add(const FaultList& others);
  /// Where many places have the same fault, the first one says it.
  void add_once(const Location& where, const std::string& problem);
  bool empty() const { return faults_.empty(); }

  /// Throws ConfigError with one line "where: error: problem" per fault, in the order of files,
  /// lines and columns.
  void throw_if_any() const;

 private:
  struct Fault {
    Location where;
    std::string problem;
  };
  std::vector<Fault> faults_;
};

}  // namespace stillpoint
