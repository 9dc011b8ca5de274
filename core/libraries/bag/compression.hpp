// The compressions that bags use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "bag/byte_reader.hpp"

namespace stillpoint::bag {

enum class Compression { kNone, kBzip2, kLz4, kZstd };

/// By its name in a bag: "", "none", "bz2", "lz4", "zstd".
std::optional<Compression> compression_named(std::string_view name);

struct Decompressed {
  std::vector<std::uint8_t> bytes;
  std::string fault;  ///< empty, or why there are no more bytes than these
};

/// As far as it goes, and at most `most` bytes. Takes no more memory than twice what comes out.
Decompressed decompress(Compression compression, ByteSpan bytes, std::size_t most);

/// A frame of zstd, as a message that was compressed for itself begins.
bool is_zstd(ByteSpan bytes);

}  // namespace stillpoint::bag
