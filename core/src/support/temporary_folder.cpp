#include "stillpoint/support/temporary_folder.hpp"

#include <stdlib.h>  // mkdtemp

#include <cerrno>
#include <string>
#include <system_error>

#include "stillpoint/error.hpp"

namespace stillpoint {

TemporaryFolder::TemporaryFolder() {
  std::error_code error;
  const std::filesystem::path parent = std::filesystem::temp_directory_path(error);
  std::string path = (parent / "stillpoint_XXXXXX").string();
  if (error || !::mkdtemp(path.data()))
    throw Error(
        Fault::kUsage,
        "cannot be made: " + (error ? error.message() : std::generic_category().message(errno)),
        "a temporary folder", "set TMPDIR to a folder that can be written");
  path_ = path;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

}  // namespace stillpoint
