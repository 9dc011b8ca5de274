// Which branches of the fuzzed parsers have been taken, from -fsanitize-coverage=trace-pc.
#pragma once

#include <cstddef>

namespace stillpoint::testing {

/// Forgets what the run before has taken.
void begin_coverage();
/// How many branches were taken since begin_coverage() that no run before had taken, or not as
/// often (1, 2, 3, 4 … 7, 8 … 15, … times).
std::size_t new_coverage();

}  // namespace stillpoint::testing
