// The cases of one type. To be called in a process that nobody else needs.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "plugin_check/finding.hpp"
#include "plugin_check/scenario.hpp"
#include "stillpoint/engine/registry.hpp"

namespace stillpoint::plugin_check {

/// A type with the options to check it with.
struct CheckedType {
  const PluginType& type;
  const std::vector<std::string>& assignments;
  const std::optional<CameraModel>& camera;
};

/// The names of the cases of a kind, in order, the usual recording first.
std::vector<std::string> cases_of(const std::string& kind, const std::vector<Scenario>& scenarios);

/// `folder` exists and is empty.
CaseResult run_case(const CheckedType& type, const std::string& name,
                    const std::vector<Scenario>& scenarios, const std::filesystem::path& folder);

}  // namespace stillpoint::plugin_check
