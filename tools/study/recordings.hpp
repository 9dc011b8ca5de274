// Simulated recordings of a study: made once.
#pragma once

#include <filesystem>
#include <stop_token>
#include <string>

#include "study/study.hpp"

namespace stillpoint::study {

/// Whether `folder` holds the complete recording of the scene that `description` says all about.
bool is_recorded(const std::filesystem::path& folder, const std::string& description);

/// Whether it holds that of another scene, or of what the scene was before it changed.
bool is_recorded_otherwise(const std::filesystem::path& folder, const std::string& description);

/// Simulates it with `program` (see run_process); the folder appears when everything is in it.
/// False: stopped before that. Throws Error when the simulation fails, with what it said.
bool record(const std::filesystem::path& program, const Sequence& sequence,
            const std::string& description, const std::filesystem::path& folder,
            const std::stop_token& stop);

}  // namespace stillpoint::study
