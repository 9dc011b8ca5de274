// Numbers as text, for messages and tables.
#pragma once

#include <string>

namespace stillpoint::evaluation {

/// `value` with `digits` decimals, padded on the left to `width`.
std::string fixed(double value, int digits, int width = 0);

}  // namespace stillpoint::evaluation
