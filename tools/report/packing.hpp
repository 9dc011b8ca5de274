// Bytes as text that a page can hold.
#pragma once

#include <string>
#include <string_view>

namespace stillpoint::report {

/// gzip (RFC 1952), which browsers unpack by DecompressionStream. The same bytes give the same.
std::string gzipped(std::string_view bytes);

}  // namespace stillpoint::report
