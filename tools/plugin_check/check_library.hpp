// Checks the stages of a plugin library: does each keep the promises of its contract, also in
// cases that its author may have forgotten?
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "plugin_check/finding.hpp"
#include "stillpoint/contracts/camera.hpp"

namespace stillpoint::plugin_check {

struct CheckRequest {
  std::filesystem::path library;
  std::string type;                      ///< TYPE or KIND/TYPE; empty: all of the library
  std::vector<std::string> assignments;  ///< `option=value`, for every type that is checked
  std::optional<CameraModel> camera;     ///< of sources that need one
  std::string only;                      ///< the name of a case; empty: all
  double seconds = 60;                   ///< that a case may take
};

struct TypeResult {
  std::string kind, type;
  std::vector<CaseResult> cases;
};

struct LibraryResult {
  std::string plugin, version;        ///< empty when the library cannot be used
  std::vector<std::string> unusable;  ///< why the library, or some of its types, cannot be used
  std::vector<TypeResult> types;
};

/// Each case runs in a process of its own, so that a crash or a hang costs that case alone. `done`
/// is called after each. Throws Error(kUsage) when there is no such library, type or
/// case.
LibraryResult check_library(
    const CheckRequest& request,
    const std::function<void(const TypeResult& type, const CaseResult& result)>& done);

}  // namespace stillpoint::plugin_check
