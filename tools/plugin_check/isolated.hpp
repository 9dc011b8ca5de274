// A function in a process of its own, which may crash, hang or end.
#pragma once

#include <functional>
#include <optional>
#include <string>

namespace stillpoint::plugin_check {

struct IsolatedEnd {
  std::optional<std::string> result;  ///< nothing: the process ended without one
  std::string how;      ///< then: "it was ended by SIGSEGV", "…did not end within 60 s"
  std::string console;  ///< the last lines of its output
};

/// Runs `function` in a child of this process and waits for it. This process must have no other
/// threads. Exceptions of `function` end the child without a result.
IsolatedEnd run_isolated(const std::function<std::string()>& function, double seconds);

}  // namespace stillpoint::plugin_check
