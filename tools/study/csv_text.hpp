// Fields of CSV (RFC 4180).
#pragma once

#include <optional>
#include <string>

namespace stillpoint::study {

/// Quoted where it has to be.
std::string csv_field(const std::string& text);

/// Empty when it is not known. Nine digits: more than any figure means, and no rounding noise.
std::string csv_number(const std::optional<double>& value);

}  // namespace stillpoint::study
