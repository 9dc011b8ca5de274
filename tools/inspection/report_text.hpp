// Rows of the tables that people read.
#pragma once

#include <ostream>
#include <string>

#include "inspection/stream_audit.hpp"

namespace stillpoint::inspection {

/// With spaces before it, `width` columns; bytes are taken for columns.
std::string right(const std::string& text, std::size_t width);

/// A line of a name and its value.
void row(std::ostream& out, const std::string& name, const std::string& value);

std::string milliseconds(double seconds, int digits = 0);

/// "60 images in 1.97 s, 30.0 Hz, no gaps"; gaps are told from `start` on, in seconds.
std::string stream_text(const StreamAudit& stream, double start);

}  // namespace stillpoint::inspection
