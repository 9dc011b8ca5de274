// Files of the user, looked at before they are read.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// Lists, descriptions and other text: a million lines of a recording.
inline constexpr std::uintmax_t kLargestText = 64 << 20;  // bytes

/// Its size in bytes. Throws Error(kData) when it is not there, no regular file (a pipe would be
/// waited for, a device has no end), or larger than `most_bytes`.
STILLPOINT_EXPORT std::uintmax_t input_file_size(const std::filesystem::path& file,
                                                 std::uintmax_t most_bytes);

/// What it holds. Throws as input_file_size() does, and when it cannot be read to its end.
STILLPOINT_EXPORT std::string read_input_file(const std::filesystem::path& file,
                                              std::uintmax_t most_bytes = kLargestText);

}  // namespace stillpoint
