// What a library was built for, read without loading it.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

namespace stillpoint {

/// Why nothing in `file` can be used by this program, by its stamp; empty when something can.
std::string why_library_does_not_fit(const std::filesystem::path& file);

/// Why a type of this kind, built for this number of its contract, cannot be used; empty when it
/// can.
std::string why_kind_does_not_fit(std::string_view kind, std::uint32_t kind_api);

}  // namespace stillpoint
