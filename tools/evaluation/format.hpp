// Numbers as text, for messages and tables.
#pragma once

#include <cstddef>
#include <string>

namespace stillpoint::evaluation {

/// `value` with `digits` decimals, padded on the left to `width`.
std::string fixed(double value, int digits, int width = 0);

/// Characters of UTF-8 text, not bytes: columns in a terminal.
std::size_t width_of(const std::string& text);

}  // namespace stillpoint::evaluation
