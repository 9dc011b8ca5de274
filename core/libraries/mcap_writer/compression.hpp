// Compression of chunks.
#pragma once

#include "mcap_writer/byte_writer.hpp"

namespace stillpoint::mcap_writer {

enum class Compression { kNone, kLz4, kZstd };

/// What MCAP calls it: "", "lz4", "zstd".
const char* name_of(Compression compression);

/// Quickly rather than tightly: a frame of LZ4, or one of Zstandard.
Bytes compressed(const Bytes& data, Compression compression);

}  // namespace stillpoint::mcap_writer
