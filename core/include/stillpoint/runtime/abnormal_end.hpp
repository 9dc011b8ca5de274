// Code of a plugin that neither returned nor threw: why, and the time that is left to save results.
#pragma once

#include <csignal>
#include <span>
#include <string>

namespace stillpoint {

/// What ended it: the number of a signal (`kGivenUp`: by the guard), or one of two values above
/// those of all signals.
inline constexpr int kGivenUp = SIGUSR2;
inline constexpr int kExited = 1000;
inline constexpr int kWroteToImage = 1001;

/// "it crashed: SIGSEGV, Segmentation fault".
std::string reason_of(int what);

/// Locks that the code held are not released, so that saving may hang: from now on it has half a
/// minute, then the process ends with exit code 1 and "error: WORDS; what followed did not return".
/// For signal handlers, too. WORDS are the parts, joined; those of the first call count.
void start_time_to_save(std::span<const char* const> words);

/// Whether that has happened since watch_time_to_save().
bool has_started_to_save();

/// Handles SIGALRM, until the second.
void watch_time_to_save();
void end_time_to_save();

/// For signal handlers.
void write_to_stderr(const char* words);

}  // namespace stillpoint
