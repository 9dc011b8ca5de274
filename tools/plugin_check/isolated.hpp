// A function in a process of its own, which may crash, hang or end.
#pragma once

#include <exception>
#include <functional>
#include <optional>
#include <string>

namespace stillpoint::plugin_check {

struct IsolatedEnd {
  std::optional<std::string> result;  ///< nothing: the process ended without one
  std::string how;      ///< then: "it was ended by SIGSEGV", "…did not end within 60 s"
  std::string console;  ///< the last lines of its output, or the first of a sanitizer's report
};

/// SIGINT or SIGTERM came while a child was waited for; the child has been ended.
struct Interrupted final : std::exception {
  explicit Interrupted(int number) : signal(number) {}
  const char* what() const noexcept override { return "interrupted"; }
  int signal;
};

/// Runs `function` in a child of this process and waits for it. This process must have no other
/// threads. Exceptions of `function` end the child without a result. Throws Interrupted.
IsolatedEnd run_isolated(const std::function<std::string()>& function, double seconds);

}  // namespace stillpoint::plugin_check
