// The chunks of a bag, most often compressed, in which its records lie.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <set>
#include <vector>

#include "bag/compression.hpp"
#include "bag/damage_list.hpp"
#include "bag/file_reader.hpp"

namespace stillpoint::bag {

struct Chunk {
  std::uint64_t begin = 0;   ///< byte of the file
  std::uint64_t stored = 0;  ///< bytes in the file
  std::uint64_t size = 0;    ///< bytes without compression
  Compression compression = Compression::kNone;
  std::uint32_t crc = 0;  ///< CRC-32 without compression; 0: not known
};

/// The larger ones of these are damage: writers make chunks of a few MiB.
constexpr std::uint64_t kLargestChunk = 1ULL << 30;  // bytes

/// Gives the bytes of chunks by their number. The file itself is chunk 0. Of compressed ones the
/// last few that were used are kept.
class Chunks {
 public:
  static constexpr std::uint32_t kFile = 0;

  /// What cannot be decompressed is told in `damage`, once per chunk. Throws Error(kData) when the
  /// file cannot be read.
  Chunks(const std::filesystem::path& file, DamageList& damage);

  /// The number of a chunk that is new.
  std::uint32_t add(const Chunk& chunk);

  /// Where a chunk begins in the file, by the index at its end.
  void add_start(std::uint64_t begin) { starts_.insert(begin); }
  /// Of the first chunk of the index behind `at`; the end of the file without one.
  std::uint64_t next_start(std::uint64_t at) const;
  /// The same, where reading goes on behind a record at `at` that is told as damaged.
  std::uint64_t skip_damage(std::uint64_t at);

  const std::filesystem::path& path() const { return file_.path(); }
  /// As stated; what of it is there, bytes() says.
  std::uint64_t size(std::uint32_t chunk) const { return chunks_[chunk].size; }

  /// Whether all bytes before `end` can be read.
  bool holds(std::uint32_t chunk, std::uint64_t end) {
    return end == 0 || (end <= size(chunk) && !bytes(chunk, end - 1, 1).empty());
  }

  /// `count` bytes of a chunk from `offset` on, fewer where it ends or cannot be decompressed;
  /// valid until the next call.
  ByteSpan bytes(std::uint32_t chunk, std::uint64_t offset, std::size_t count);

 private:
  struct Cached {
    std::uint32_t chunk = kFile;  // kFile: none
    std::vector<std::uint8_t> bytes;
  };
  const Cached& decompressed(std::uint32_t chunk);
  void check(const Chunk& chunk, const Decompressed& result);

  FileReader file_;
  DamageList& damage_;
  std::vector<Chunk> chunks_;
  std::set<std::uint64_t> starts_;
  std::vector<bool> checked_;
  // Colour and depth of a moment may lie in neighbouring chunks that take turns.
  std::array<Cached, 3> cache_;
  std::size_t oldest_ = 0;
};

}  // namespace stillpoint::bag
