// Looks into a shared library without loading it.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace stillpoint {

/// Why `file` is not a complete shared library for this machine that exports `symbol`; empty when
/// it is. dlopen() of a truncated file can kill the process, hence the completeness.
///
/// boost::dll::library_info is not used for this: it trusts every offset in the file, and it reads
/// the table of debugging symbols, which `strip` and packaging remove.
std::string why_not_exporting(const std::filesystem::path& file, std::string_view symbol);

}  // namespace stillpoint
