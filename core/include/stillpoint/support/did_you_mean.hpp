// Suggestions for mistyped names.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b`.
STILLPOINT_EXPORT std::size_t edit_distance(std::string_view a, std::string_view b);

/// "; did you mean 'x'?", or nothing when no candidate is near.
STILLPOINT_EXPORT std::string did_you_mean(std::string_view word,
                                           const std::vector<std::string>& candidates);

/// "a, b, c".
STILLPOINT_EXPORT std::string join(const std::vector<std::string>& words,
                                   std::string_view separator = ", ");

}  // namespace stillpoint
