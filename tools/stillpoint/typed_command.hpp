// The command line of this call.
#pragma once

#include <string>

namespace stillpoint {

/// For a shell: "stillpoint report 'a run' -o page.html". Paths are as they were typed.
std::string typed_command();

/// Two lines that stand below a table: that command; version, commit, machine and date.
std::string made_by();

}  // namespace stillpoint
