// Compression of chunks.
#pragma once

#include "ros2_messages/byte_writer.hpp"

namespace stillpoint::ros2_messages {

enum class Compression { kNone, kLz4, kZstd };

/// What MCAP calls it: "", "lz4", "zstd".
const char* name_of(Compression compression);

/// Quickly rather than tightly: a frame of LZ4, or one of Zstandard.
Bytes compressed(const Bytes& data, Compression compression);

}  // namespace stillpoint::ros2_messages
