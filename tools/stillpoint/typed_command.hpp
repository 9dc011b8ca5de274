// The command line of this call.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

namespace stillpoint {

/// For a shell: "stillpoint report 'a run' -o page.html". Paths are as they were typed.
std::string typed_command();

/// Two lines that stand below a table: that command; version, commit, machine and date.
std::string made_by();

/// The same, as an object with those five.
nlohmann::ordered_json made_by_json();

}  // namespace stillpoint
