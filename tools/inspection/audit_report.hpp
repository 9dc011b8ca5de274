// The audit of a recording as text for people and as JSON for programs.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "inspection/recording_audit.hpp"

namespace stillpoint::inspection {

/// A table, a histogram of depth and the warnings.
std::string report_table(const RecordingAudit& audit);

/// Seconds, metres and shares from 0 to 1 throughout.
nlohmann::ordered_json report_json(const RecordingAudit& audit);

}  // namespace stillpoint::inspection
