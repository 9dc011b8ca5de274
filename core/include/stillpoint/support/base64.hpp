// Bytes as text, for what is within a page.
#pragma once

#include <string>
#include <string_view>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// RFC 4648, section 4, with padding and without line breaks.
STILLPOINT_EXPORT std::string base64(std::string_view bytes);

}  // namespace stillpoint
