#include "bag/chunks.hpp"

#include <libdeflate.h>

#include <algorithm>

namespace stillpoint::bag {

Chunks::Chunks(const std::filesystem::path& file, DamageList& damage)
    : file_(file), damage_(damage) {
  add({.stored = file_.size(), .size = file_.size()});
}

std::uint32_t Chunks::add(const Chunk& chunk) {
  chunks_.push_back(chunk);
  checked_.push_back(false);
  return static_cast<std::uint32_t>(chunks_.size() - 1);
}

std::uint64_t Chunks::next_start(std::uint64_t at) const {
  const auto next = starts_.upper_bound(at);
  return next == starts_.end() ? file_.size() : std::min(*next, file_.size());
}

std::uint64_t Chunks::skip_damage(std::uint64_t at) {
  const std::uint64_t next = next_start(at);
  damage_.add("bytes " + std::to_string(at) + " to " + std::to_string(next) + " cannot be read" +
              (next == file_.size() ? ": the file is cut off or damaged" : ""));
  return next;
}

ByteSpan Chunks::bytes(std::uint32_t number, std::uint64_t offset, std::size_t count) {
  const Chunk& chunk = chunks_[number];
  if (offset >= chunk.size) return {};
  count = static_cast<std::size_t>(std::min<std::uint64_t>(count, chunk.size - offset));
  if (chunk.compression == Compression::kNone) return file_.bytes(chunk.begin + offset, count);
  const ByteSpan all = decompressed(number).bytes;
  if (offset >= all.size()) return {};
  const auto from = static_cast<std::size_t>(offset);
  return all.subspan(from, std::min(count, all.size() - from));
}

const Chunks::Cached& Chunks::decompressed(std::uint32_t number) {
  for (const Cached& cached : cache_)
    if (cached.chunk == number) return cached;
  const Chunk& chunk = chunks_[number];
  Cached& place = cache_[oldest_];
  oldest_ = (oldest_ + 1) % cache_.size();
  place = {};
  Decompressed result = decompress(chunk.compression,
                                   file_.bytes(chunk.begin, static_cast<std::size_t>(chunk.stored)),
                                   static_cast<std::size_t>(chunk.size));
  if (!checked_[number]) check(chunk, result);
  checked_[number] = true;
  place = {number, std::move(result.bytes)};
  return place;
}

void Chunks::check(const Chunk& chunk, const Decompressed& result) {
  const std::string where = "the chunk at byte " + std::to_string(chunk.begin) + ": ";
  if (!result.fault.empty() || result.bytes.size() < chunk.size)
    damage_.add(where + (result.fault.empty() ? "it holds less than it says" : result.fault) +
                "; " + std::to_string(result.bytes.size()) + " of " + std::to_string(chunk.size) +
                " bytes could be read");
  else if (chunk.crc != 0 &&
           libdeflate_crc32(0, result.bytes.data(), result.bytes.size()) != chunk.crc)
    damage_.add(where + "its checksum is wrong");
}

}  // namespace stillpoint::bag
