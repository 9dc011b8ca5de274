// The commit that the program was built from.
#pragma once

#include <string>

namespace stillpoint {

/// "4b72915a81c2", with "-dirty" behind where files had been changed; empty outside a git
/// repository.
std::string built_from_commit();

}  // namespace stillpoint
