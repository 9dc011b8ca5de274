// The compressions that bags use.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
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

/// A frame of zstd, as a file begins that was compressed as a whole.
bool is_zstd(ByteSpan bytes);

/// Messages that may be compressed each for itself, as `ros2 bag record --compression-mode message`
/// does with zstd.
class MessageBytes {
 public:
  /// The first `at_most` bytes of a message, of which `stored` gives the first `count` as they are
  /// stored; valid until the next call. Throws Error(kData) with `where` when they cannot be
  /// decompressed.
  ByteSpan first(std::size_t at_most, const std::string& where,
                 const std::function<ByteSpan(std::size_t count)>& stored);

 private:
  std::vector<std::uint8_t> decompressed_;
};

}  // namespace stillpoint::bag
