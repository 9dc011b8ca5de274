// Looks into a shared library without loading it.
#pragma once

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace stillpoint {

/// `file` is no complete shared library for this machine. dlopen() of a truncated one can kill the
/// process.
struct UnusableFile : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The bytes of an object that a shared library exports, as they lie in the file, before
/// relocation; nothing when it exports none of that name. Throws UnusableFile.
///
/// boost::dll::library_info is not used for this: it trusts every offset in the file, and it reads
/// the table of debugging symbols, which `strip` and packaging remove.
std::optional<std::string> exported_object(const std::filesystem::path& file,
                                           std::string_view symbol);

}  // namespace stillpoint
