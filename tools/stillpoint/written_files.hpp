// The list of files that a run has written under names that are not always the same: the next run
// into the folder removes them.
#pragma once

#include <filesystem>
#include <vector>

namespace stillpoint {

inline constexpr const char* kWrittenFiles = "files.txt";  // in the run folder

/// Into the list of the folder `run`: files with their sizes and times; paths are relative to it.
/// No list when there are none. Throws Error when it cannot be written.
void list_written(const std::filesystem::path& run,
                  const std::vector<std::filesystem::path>& files);

/// Whether a file begins as such a list does.
bool is_list_of_a_run(const std::filesystem::path& file);

/// Whether it is a file in the folder `run` or below, not reached through a link.
bool lies_in_run(const std::filesystem::path& file, const std::filesystem::path& run);

/// Of the files in the list those that are as they were written, of the same size and time, and
/// that lie in the run.
std::vector<std::filesystem::path> listed_in(const std::filesystem::path& run);

}  // namespace stillpoint
