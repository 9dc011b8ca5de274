// What is wrong with a recording, in words.
#pragma once

#include <string>
#include <vector>

#include "inspection/recording_audit.hpp"

namespace stillpoint::inspection {

using tum_recording::RecordingOptions;

/// One line each, with what to do about it. `pairing`: how the pairs were made.
std::vector<std::string> audit_warnings(const RecordingAudit& audit,
                                        const RecordingOptions& pairing);

}  // namespace stillpoint::inspection
