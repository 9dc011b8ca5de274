#include "bag/ros1_bag.hpp"

#include <algorithm>

namespace stillpoint::bag {
namespace {

enum class Operation : std::uint8_t {
  kNone = 0x00,
  kMessage = 0x02,
  kBagHeader = 0x03,
  kIndexData = 0x04,
  kChunk = 0x05,
  kChunkInfo = 0x06,
  kConnection = 0x07,
};

constexpr std::uint32_t kLargestHeader = 1 << 20;  // bytes; a name and some numbers

std::int64_t nanoseconds(ByteReader& reader) {
  const std::int64_t whole = reader.number<std::uint32_t>();
  return whole * 1'000'000'000 + reader.number<std::uint32_t>();
}

/// The fields of a header: `length name=value` each.
template <class Function>
void for_each_field(ByteSpan header, Function use) {
  ByteReader reader(header);
  while (reader.left() > 0) {
    const ByteSpan field = reader.byte_sequence();
    const auto sign = std::ranges::find(field, '=');
    if (sign == field.end()) throw Error(Fault::kData, "a field without a value");
    const std::string name(field.begin(), sign);
    use(name, field.subspan(name.size() + 1));
  }
}

std::string text_of(ByteSpan bytes) { return {bytes.begin(), bytes.end()}; }

}  // namespace

/// One record: what its header says, and where its data are.
struct Ros1Bag::Record {
  Operation operation = Operation::kNone;
  std::uint32_t connection = 0;
  std::uint32_t size = 0;   // of a chunk, without compression
  std::uint64_t place = 0;  // byte of the file where the index begins, or a chunk of it
  std::int64_t time = 0;    // ns
  std::string topic, compression;
  std::uint64_t begin = 0;   // of the record
  std::uint64_t data = 0;    // begin of its data
  std::uint64_t stored = 0;  // bytes of its data
  std::uint64_t end() const { return data + stored; }

  void read_field(const std::string& name, ByteSpan value) {
    ByteReader reader(value);
    if (name == "op") operation = Operation{reader.number<std::uint8_t>()};
    if (name == "conn") connection = reader.number<std::uint32_t>();
    if (name == "size") size = reader.number<std::uint32_t>();
    if (name == "index_pos" || name == "chunk_pos") place = reader.number<std::uint64_t>();
    if (name == "topic") topic = text_of(value);
    if (name == "compression") compression = text_of(value);
    if (name == "time") time = nanoseconds(reader);
  }
};

Ros1Bag::Ros1Bag(const std::filesystem::path& file) : chunks_(file, damage_) {
  const auto header = record_at(Chunks::kFile, kRos1Magic.size());
  if (!header || header->operation != Operation::kBagHeader)
    damage_.add("the header of the bag is damaged");
  else if (header->place == 0)
    damage_.add("the recording was not finished: there is no index at its end");
  else
    read_index(header->place);
  read_file();
  sort_messages();
}

/// Nothing where there is no whole header. The data may reach beyond the end.
std::optional<Ros1Bag::Record> Ros1Bag::record_at(std::uint32_t chunk, std::uint64_t offset) {
  try {
    const auto size = ByteReader(chunks_.bytes(chunk, offset, 4)).number<std::uint32_t>();
    if (size > kLargestHeader) return std::nullopt;
    ByteReader reader(chunks_.bytes(chunk, offset + 4, size + 4));
    Record record;
    for_each_field(reader.take(size), [&](const std::string& name, ByteSpan value) {
      record.read_field(name, value);
    });
    if (record.operation == Operation::kNone) return std::nullopt;
    record.begin = offset;
    record.stored = reader.number<std::uint32_t>();
    record.data = offset + 8 + size;
    return record;
  } catch (const Error&) {  // of ByteReader
    return std::nullopt;
  }
}

/// At the end of a finished bag: its connections, and where its chunks are.
void Ros1Bag::read_index(std::uint64_t begin) {
  for (std::uint64_t at = begin; at < chunks_.size(Chunks::kFile);) {
    const auto record = record_at(Chunks::kFile, at);
    if (!record) return damage_.add("the index at the end is damaged");
    if (record->operation == Operation::kConnection) add_connection(Chunks::kFile, *record);
    if (record->operation == Operation::kChunkInfo) chunks_.add_start(record->place);
    at = record->end();
  }
}

void Ros1Bag::read_file() {
  const std::uint64_t size = chunks_.size(Chunks::kFile);
  for (std::uint64_t at = kRos1Magic.size(); at < size;) {
    const auto record = record_at(Chunks::kFile, at);
    if (record && record->operation == Operation::kChunk) {
      at = read_chunk(*record);
    } else if (record && record->end() <= chunks_.next_start(at)) {
      if (record->operation == Operation::kConnection) add_connection(Chunks::kFile, *record);
      if (record->operation == Operation::kMessage) add_message(Chunks::kFile, *record);
      at = record->end();
    } else {
      at = chunks_.skip_damage(at);
    }
  }
}

/// Returns where to go on.
std::uint64_t Ros1Bag::read_chunk(const Record& record) {
  const std::uint64_t limit = chunks_.next_start(record.begin);
  const auto chunk = add_chunk(record, limit);
  std::uint64_t at = std::min(record.end(), limit);
  if (!chunk) return at;
  const std::size_t before = messages_.size();
  bool indexed = false;
  bool complete = true;  // all that is in the chunk is known
  while (const auto index = record_at(Chunks::kFile, at)) {
    if (index->operation != Operation::kIndexData || index->end() > chunks_.size(Chunks::kFile))
      break;
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
std::optional<std::uint32_t> Ros1Bag::add_chunk(const Record& record, std::uint64_t limit) {
  const std::string where = "the chunk at byte " + std::to_string(record.begin);
  const auto compression = compression_named(record.compression);
  const std::uint64_t stored = std::min(record.stored, limit - std::min(limit, record.data));
  const std::uint64_t size = compression == Compression::kNone ? stored : record.size;
  if (!compression || std::max(stored, size) > kLargestChunk) {
    damage_.add(where + (compression ? " has an impossible size"
                                     : " has a compression that is not known, '" +
                                           record.compression + "'"));
    return std::nullopt;
  }
  if (stored < record.stored) damage_.add("the file is cut off or damaged in " + where);
  return chunks_.add(
      {.begin = record.data, .stored = stored, .size = size, .compression = *compression});
}

/// The messages of one connection in a chunk; nothing when the connection is not known.
bool Ros1Bag::add_indexed(const Record& record, std::uint32_t chunk) {
  const auto topic = topic_of_.find(record.connection);
  if (topic == topic_of_.end()) return false;
  ByteReader reader(
      chunks_.bytes(Chunks::kFile, record.data, static_cast<std::size_t>(record.stored)));
  constexpr std::size_t kEntry = 12;  // bytes
  while (reader.left() >= kEntry) {
    const std::int64_t time = nanoseconds(reader);
    messages_.push_back({time, topic->second, 0, chunk, reader.number<std::uint32_t>()});
  }
  return true;
}

/// As far as the chunk goes.
void Ros1Bag::scan(std::uint32_t chunk) {
  for (std::uint64_t at = 0;;) {
    const auto record = record_at(chunk, at);
    if (!record || !chunks_.holds(chunk, record->end())) return;
    if (record->operation == Operation::kConnection) add_connection(chunk, *record);
    if (record->operation == Operation::kMessage) add_message(chunk, *record);
    at = record->end();
  }
}

/// The data are a header, too: of the publisher, as it told the recorder.
void Ros1Bag::add_connection(std::uint32_t chunk, const Record& record) {
  if (topic_of_.contains(record.connection) || record.stored > kLargestChunk) return;
  Topic topic{.name = record.topic, .encoding = "ros1", .serialisation = Serialisation::kRos1};
  try {
    for_each_field(chunks_.bytes(chunk, record.data, static_cast<std::size_t>(record.stored)),
                   [&](const std::string& name, ByteSpan value) {
                     if (name == "type") topic.type = text_of(value);
                   });
  } catch (const Error&) {
    return damage_.add("the connection at byte " + std::to_string(record.begin) + " is damaged");
  }
  topic_of_[record.connection] = add_topic(std::move(topic));
}

void Ros1Bag::add_message(std::uint32_t chunk, const Record& record) {
  const auto topic = topic_of_.find(record.connection);
  if (topic != topic_of_.end())
    messages_.push_back({record.time, topic->second, 0, chunk, record.begin});
}

ByteSpan Ros1Bag::read(const MessagePlace& place, std::size_t at_most) {
  const auto record = record_at(place.chunk, place.position);
  const auto wanted = static_cast<std::size_t>(
      std::min<std::uint64_t>({at_most, record ? record->stored : 0, kLargestChunk}));
  const ByteSpan bytes = record ? chunks_.bytes(place.chunk, record->data, wanted) : ByteSpan();
  if (!record || record->operation != Operation::kMessage || bytes.size() < wanted)
    throw Error(Fault::kData, "the message is damaged", chunks_.path().string());
  return bytes;
}

}  // namespace stillpoint::bag
