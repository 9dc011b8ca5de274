#include "bag/mcap_file.hpp"

#include <algorithm>

namespace stillpoint::bag {
namespace {

enum class Opcode : std::uint8_t {
  kNone = 0x00,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kDataEnd = 0x0f,
};

constexpr std::size_t kRecordHeader = 1 + 8;           // bytes: opcode, length
constexpr std::size_t kMessageHeader = 2 + 4 + 8 + 8;  // bytes: channel, number, two times

Serialisation serialisation_of(const std::string& encoding) {
  if (encoding == "cdr") return Serialisation::kCdr;
  if (encoding == "ros1") return Serialisation::kRos1;
  return Serialisation::kOther;
}

}  // namespace

struct McapFile::Record {
  Opcode opcode = Opcode::kNone;
  std::uint64_t begin = 0;
  std::uint64_t size = 0;  // of its content
  std::uint64_t content() const { return begin + kRecordHeader; }
  std::uint64_t end() const { return content() + size; }
};

McapFile::McapFile(const std::filesystem::path& file) : chunks_(file, damage_) {
  read_summary();
  read_data();
  sort_messages();
}

/// Nothing where the record is not whole; chunks of the file may reach beyond its end.
std::optional<McapFile::Record> McapFile::record_at(std::uint32_t chunk, std::uint64_t offset) {
  const ByteSpan bytes = chunks_.bytes(chunk, offset, kRecordHeader);
  if (bytes.size() < kRecordHeader || bytes[0] == 0) return std::nullopt;
  ByteReader reader(bytes);
  Record record{.opcode = Opcode{reader.number<std::uint8_t>()}, .begin = offset};
  record.size = reader.number<std::uint64_t>();
  const std::uint64_t left = chunks_.size(chunk) - offset - kRecordHeader;
  const bool may_be_cut = chunk == Chunks::kFile && record.opcode == Opcode::kChunk;
  if (record.size > (may_be_cut ? kLargestChunk : left)) return std::nullopt;
  return record;
}

ByteReader McapFile::content(std::uint32_t chunk, const Record& record) {
  if (record.size > kLargestChunk) throw Error(Fault::kData, "the record is too large");
  return ByteReader(chunks_.bytes(chunk, record.content(), static_cast<std::size_t>(record.size)));
}

/// At the end of a finished file: schemas, channels, and where the chunks are.
void McapFile::read_summary() {
  constexpr std::size_t kFooterSize = kRecordHeader + 8 + 8 + 4;  // bytes
  const std::uint64_t size = chunks_.size(Chunks::kFile);
  if (size < kMcapMagic.size() + kFooterSize) return;
  const auto footer = record_at(Chunks::kFile, size - kMcapMagic.size() - kFooterSize);
  if (!footer || footer->opcode != Opcode::kFooter) return;  // read_data() finds the end missing
  const auto begin = content(Chunks::kFile, *footer).number<std::uint64_t>();
  if (begin == 0) return;
  for (std::uint64_t at = begin; at < footer->begin;) {
    const auto record = record_at(Chunks::kFile, at);
    if (!record) return damage_.add("the summary at the end is damaged");
    if (record->opcode == Opcode::kSchema || record->opcode == Opcode::kChannel ||
        record->opcode == Opcode::kChunkIndex)
      read_small_record(Chunks::kFile, *record);
    at = record->end();
  }
}

void McapFile::read_data() {
  const std::uint64_t size = chunks_.size(Chunks::kFile);
  bool ended = false;
  for (std::uint64_t at = kMcapMagic.size(); at < size && !ended;) {
    const auto record = record_at(Chunks::kFile, at);
    const bool is_chunk = record && record->opcode == Opcode::kChunk;
    if (!record || (!is_chunk && record->end() > chunks_.next_start(at))) {
      at = chunks_.skip_damage(at);
      if (at == size) return;
      continue;
    }
    ended = record->opcode == Opcode::kDataEnd || record->opcode == Opcode::kFooter;
    if (!is_chunk) read_small_record(Chunks::kFile, *record);
    at = is_chunk ? read_chunk(*record) : record->end();
  }
  if (!ended) damage_.add("the recording was not finished, or its end is missing");
}

/// Returns where to go on.
std::uint64_t McapFile::read_chunk(const Record& record) {
  const std::uint64_t limit = chunks_.next_start(record.begin);
  const auto chunk = add_chunk(record, limit);
  std::uint64_t at = std::min(record.end(), limit);
  if (!chunk) return at;
  const std::size_t before = messages_.size();
  bool indexed = false;
  bool complete = true;  // all that is in the chunk is known
  for (auto index = record_at(Chunks::kFile, at); index && index->opcode == Opcode::kMessageIndex;
       index = record_at(Chunks::kFile, at)) {
    indexed = true;
    complete = complete && add_indexed(*index, *chunk);
    at = index->end();
  }
  if (indexed && complete) return at;
  messages_.resize(before);
  scan(*chunk);
  return at;
}

/// Its bytes are those before `limit`.
std::optional<std::uint32_t> McapFile::add_chunk(const Record& record, std::uint64_t limit) {
  const std::string where = "the chunk at byte " + std::to_string(record.begin);
  try {
    constexpr std::size_t kHeader = 64;  // bytes: enough for what stands before its records
    ByteReader reader(chunks_.bytes(Chunks::kFile, record.content(), kHeader));
    reader.skip(8 + 8);  // first and last time
    Chunk chunk{.size = reader.number<std::uint64_t>()};
    chunk.crc = reader.number<std::uint32_t>();
    const std::string name = reader.text();
    const auto compression = compression_named(name);
    const auto stored = reader.number<std::uint64_t>();
    chunk.begin = record.content() + reader.position();
    const std::uint64_t left = limit - std::min(limit, chunk.begin);
    chunk.stored = std::min(stored, left);
    if (!compression || chunk.begin > record.end() || stored > record.end() - chunk.begin ||
        chunk.size > kLargestChunk) {
      damage_.add(where + (compression ? " has an impossible size"
                                       : " has a compression that is not known, '" + name + "'"));
      return std::nullopt;
    }
    chunk.compression = *compression;
    if (chunk.compression == Compression::kNone) chunk.size = chunk.stored;
    if (stored > left || record.end() > limit)
      damage_.add("the file is cut off or damaged in " + where);
    return chunks_.add(chunk);
  } catch (const Error&) {  // of ByteReader
    damage_.add(where + " is damaged");
    return std::nullopt;
  }
}

/// The messages of one channel in a chunk; false when the channel is not known.
bool McapFile::add_indexed(const Record& record, std::uint32_t chunk) {
  try {
    ByteReader reader = content(Chunks::kFile, record);
    const auto topic = topic_of_.find(reader.number<std::uint16_t>());
    if (topic == topic_of_.end()) return false;
    ByteReader entries(reader.byte_sequence());
    while (entries.left() > 0) {
      const auto time = static_cast<std::int64_t>(entries.number<std::uint64_t>());
      messages_.push_back({time, topic->second, 0, chunk, entries.number<std::uint64_t>()});
    }
    return true;
  } catch (const Error&) {  // of ByteReader
    return false;
  }
}

/// As far as the chunk goes.
void McapFile::scan(std::uint32_t chunk) {
  for (std::uint64_t at = 0;;) {
    const auto record = record_at(chunk, at);
    if (!record || !chunks_.holds(chunk, record->end())) return;
    read_small_record(chunk, *record);
    at = record->end();
  }
}

/// One that is no chunk.
void McapFile::read_small_record(std::uint32_t chunk, const Record& record) {
  try {
    if (record.opcode == Opcode::kSchema) {
      ByteReader reader = content(chunk, record);
      const auto number = reader.number<std::uint16_t>();
      type_of_.emplace(number, ros1_type(reader.text()));
    } else if (record.opcode == Opcode::kChannel) {
      add_channel(content(chunk, record));
    } else if (record.opcode == Opcode::kChunkIndex) {
      ByteReader reader = content(chunk, record);
      reader.skip(8 + 8);  // first and last time
      chunks_.add_start(reader.number<std::uint64_t>());
    } else if (record.opcode == Opcode::kMessage) {
      ByteReader reader(chunks_.bytes(chunk, record.content(), kMessageHeader));
      const auto topic = topic_of_.find(reader.number<std::uint16_t>());
      reader.skip(4);  // its number
      const auto time = static_cast<std::int64_t>(reader.number<std::uint64_t>());
      if (topic != topic_of_.end())
        messages_.push_back({time, topic->second, 0, chunk, record.begin});
    }
  } catch (const Error& error) {  // of ByteReader
    damage_.add("the record at byte " + std::to_string(record.begin) + ": " + error.what());
  }
}

void McapFile::add_channel(ByteReader reader) {
  const auto number = reader.number<std::uint16_t>();
  const auto schema = reader.number<std::uint16_t>();
  if (topic_of_.contains(number)) return;
  Topic topic{.name = reader.text(), .type = type_of_[schema]};
  topic.encoding = reader.text();
  topic.serialisation = serialisation_of(topic.encoding);
  topic_of_[number] = add_topic(std::move(topic));
}

ByteSpan McapFile::read(const MessagePlace& place, std::size_t at_most) {
  const std::string file = chunks_.path().string();
  const auto record = record_at(place.chunk, place.position);
  if (!record || record->opcode != Opcode::kMessage || record->size < kMessageHeader)
    throw Error(Fault::kData, "the message is damaged", file);
  return message_.first(at_most, file, [&](std::size_t count) {
    const auto wanted = static_cast<std::size_t>(
        std::min<std::uint64_t>({count, record->size - kMessageHeader, kLargestChunk}));
    const ByteSpan bytes = chunks_.bytes(place.chunk, record->content() + kMessageHeader, wanted);
    if (bytes.size() < wanted) throw Error(Fault::kData, "the message is damaged", file);
    return bytes;
  });
}

}  // namespace stillpoint::bag
