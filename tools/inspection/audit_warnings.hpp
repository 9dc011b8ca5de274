// What is wrong with a recording, in words.
#pragma once

#include <string>
#include <vector>

#include "inspection/recording_audit.hpp"

namespace stillpoint::inspection {

using tum_recording::RecordingOptions;

/// Of images and their times, one line each, with what to do about it. `max_difference` in seconds,
/// by which pairs were made; `offset_advice`: what helps when the clocks differ.
std::vector<std::string> pair_warnings(const PairAudit& audit, double max_difference,
                                       const std::string& offset_advice);

/// For pairs that were made with another one, in seconds.
std::string time_offset_advice(double time_offset);

/// All of a recording in a folder. `pairing`: how the pairs were made.
std::vector<std::string> audit_warnings(const RecordingAudit& audit,
                                        const RecordingOptions& pairing);

}  // namespace stillpoint::inspection
