#include "ros2_messages/mcap_writer.hpp"

#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <exception>
#include <string_view>

#include "ros2_messages/message_type.hpp"
#include "stillpoint/error.hpp"

// Names of records and fields are those of the specification, https://mcap.dev/spec.
namespace stillpoint::ros2_messages {
namespace {

enum Opcode : std::uint8_t {
  kHeader = 0x01,
  kFooter = 0x02,
  kSchema = 0x03,
  kChannel = 0x04,
  kMessage = 0x05,
  kChunk = 0x06,
  kMessageIndex = 0x07,
  kChunkIndex = 0x08,
  kStatistics = 0x0B,
  kSummaryOffset = 0x0E,
  kDataEnd = 0x0F,
};

constexpr std::array<std::uint8_t, 8> kMagic = {0x89, 'M', 'C', 'A', 'P', '0', '\r', '\n'};
constexpr std::size_t kChunkBytes = 1 << 20;
constexpr std::uint64_t kChunkTime = 1'000'000'000;  // ns
constexpr std::size_t kMaxIds = 0xffff;              // of channels

void append_text(Bytes& out, std::string_view text) {
  append(out, static_cast<std::uint32_t>(text.size()));
  append_letters(out, text);
}

/// Of arrays and maps, whose length counts bytes.
void append_sized(Bytes& out, const Bytes& content) {
  append(out, static_cast<std::uint32_t>(content.size()));
  append(out, content);
}

void append_record(Bytes& out, Opcode opcode, const Bytes& content) {
  append(out, static_cast<std::uint8_t>(opcode));
  append(out, static_cast<std::uint64_t>(content.size()));
  append(out, content);
}

Bytes record(Opcode opcode, const Bytes& content) {
  Bytes out;
  append_record(out, opcode, content);
  return out;
}

Bytes header() {
  Bytes content;
  append_text(content, "ros2");
  append_text(content, "stillpoint");
  return record(kHeader, content);
}

Bytes schema(std::uint16_t id, const std::string& type) {
  Bytes content;
  append(content, id);
  append_text(content, schema_name(type));
  append_text(content, "ros2msg");
  append_text(content, schema_text(type));
  return record(kSchema, content);
}

Bytes channel(ChannelId id, std::uint16_t schema_id, const std::string& topic) {
  Bytes content;
  append(content, id);
  append(content, schema_id);
  append_text(content, topic);
  append_text(content, "cdr");
  append_sized(content, {});  // metadata
  return record(kChannel, content);
}

/// CRC-32 of bytes that follow others, whose own is `crc`.
std::uint32_t crc_of(std::span<const std::uint8_t> bytes, std::uint32_t crc = 0) {
  return libdeflate_crc32(crc, bytes.data(), bytes.size());
}

/// A part of the summary, and where it is.
void append_group(Bytes& summary, Bytes& offsets, std::uint64_t begin, Opcode opcode,
                  std::span<const Bytes> records) {
  if (records.empty()) return;
  const std::uint64_t start = begin + summary.size();
  for (const Bytes& each : records) append(summary, each);
  Bytes content;
  append(content, static_cast<std::uint8_t>(opcode));
  append(content, start);
  append(content, begin + summary.size() - start);
  append_record(offsets, kSummaryOffset, content);
}

}  // namespace

void McapWriter::TimeRange::add(std::uint64_t time) {
  first = std::min(first, time);
  last = std::max(last, time);
}

McapWriter::McapWriter(std::filesystem::path file, Compression compression)
    : path_(std::move(file)), compression_(compression) {}

McapWriter::~McapWriter() {
  try {
    if (messages_ > 0) finish();
  } catch (const std::exception&) {  // of interest to those who call finish()
  }
}

ChannelId McapWriter::add_channel(const std::string& topic, const std::string& type) {
  if (channels_.size() == kMaxIds) throw Error(Fault::kStage, "too many topics", path_.string());
  const auto id = static_cast<ChannelId>(channels_.size());
  channels_.push_back({.record = channel(id, schema_of(type), topic)});
  append(chunk_, channels_.back().record);
  return id;
}

std::uint16_t McapWriter::schema_of(const std::string& type) {
  const auto [entry, is_new] =
      schemas_.try_emplace(type, static_cast<std::uint16_t>(schemas_.size() + 1));  // 0: none
  if (is_new) {
    schema_records_.push_back(schema(entry->second, type));
    append(chunk_, schema_records_.back());
  }
  return entry->second;
}

void McapWriter::write(ChannelId id, std::uint64_t time, const Bytes& data) {
  if (ended_) return;
  Channel& channel = channels_.at(id);
  channel.index.emplace_back(time, chunk_.size());
  Bytes fields;
  append(fields, id);
  append(fields, channel.messages++);  // sequence
  append(fields, time);                // log_time
  append(fields, time);                // publish_time
  append(chunk_, static_cast<std::uint8_t>(kMessage));
  append(chunk_, static_cast<std::uint64_t>(fields.size() + data.size()));
  append(chunk_, fields);
  append(chunk_, data);
  chunk_times_.add(time);
  times_.add(time);
  ++messages_;
  if (chunk_.size() >= kChunkBytes || chunk_times_.last - chunk_times_.first >= kChunkTime)
    end_chunk();
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const Bytes records = compressed(chunk_, compression_);
  Bytes content;
  append(content, chunk_times_.start());
  append(content, chunk_times_.last);
  append(content, static_cast<std::uint64_t>(chunk_.size()));
  append(content, crc_of(chunk_));
  append_text(content, name_of(compression_));
  append(content, static_cast<std::uint64_t>(records.size()));
  append(content, records);
  if (position_ == 0) {
    put(kMagic);
    put(header());
  }
  Bytes out = record(kChunk, content);
  const auto chunk_length = static_cast<std::uint64_t>(out.size());
  Bytes offsets;
  append_message_indices(out, offsets, position_);

  Bytes index;
  append(index, chunk_times_.start());
  append(index, chunk_times_.last);
  append(index, position_);  // chunk_start_offset
  append(index, chunk_length);
  append_sized(index, offsets);
  append(index, static_cast<std::uint64_t>(out.size()) - chunk_length);  // message_index_length
  append_text(index, name_of(compression_));
  append(index, static_cast<std::uint64_t>(records.size()));
  append(index, static_cast<std::uint64_t>(chunk_.size()));
  put(out);
  chunk_indices_.push_back(record(kChunkIndex, index));
  chunk_.clear();
  chunk_times_ = {};
}

/// Behind the chunk, which begins at `at` of the file. `offsets`: where each is in the file, by
/// channel.
void McapWriter::append_message_indices(Bytes& out, Bytes& offsets, std::uint64_t at) {
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    auto& index = channels_[id].index;
    if (index.empty()) continue;
    append(offsets, static_cast<ChannelId>(id));
    append(offsets, at + out.size());
    Bytes entries;
    for (const auto& [time, offset] : index) {
      append(entries, time);
      append(entries, offset);
    }
    Bytes content;
    append(content, static_cast<ChannelId>(id));
    append_sized(content, entries);
    append_record(out, kMessageIndex, content);
    index.clear();
  }
}

void McapWriter::finish() {
  if (ended_) return;
  end_chunk();
  if (position_ == 0) {
    put(kMagic);
    put(header());
  }
  Bytes data_end;
  append(data_end, crc_);  // data_section_crc
  put(record(kDataEnd, data_end));
  put(summary(position_));
  put(kMagic);
  ended_ = true;
  stream_.close();
}

/// All from the first record of the summary, which will be at `begin` of the file, to the footer.
Bytes McapWriter::summary(std::uint64_t begin) const {
  Bytes out, offsets;
  std::vector<Bytes> channel_records;
  for (const Channel& each : channels_) channel_records.push_back(each.record);
  append_group(out, offsets, begin, kSchema, schema_records_);
  append_group(out, offsets, begin, kChannel, channel_records);
  append_group(out, offsets, begin, kStatistics, std::array{statistics()});
  append_group(out, offsets, begin, kChunkIndex, chunk_indices_);
  const std::uint64_t offset_start = begin + out.size();
  append(out, offsets);
  append(out, static_cast<std::uint8_t>(kFooter));
  append(out, std::uint64_t{20});  // bytes of what follows
  append(out, begin);              // summary_start
  append(out, offset_start);       // summary_offset_start
  append(out, crc_of(out));        // summary_crc, of all of it until here
  return out;
}

Bytes McapWriter::statistics() const {
  Bytes counts;
  for (std::size_t id = 0; id < channels_.size(); ++id) {
    append(counts, static_cast<ChannelId>(id));
    append(counts, static_cast<std::uint64_t>(channels_[id].messages));
  }
  Bytes content;
  append(content, messages_);
  append(content, static_cast<std::uint16_t>(schema_records_.size()));
  append(content, static_cast<std::uint32_t>(channels_.size()));
  append(content, std::uint32_t{0});  // attachments
  append(content, std::uint32_t{0});  // metadata
  append(content, static_cast<std::uint32_t>(chunk_indices_.size()));
  append(content, times_.start());
  append(content, times_.last);
  append_sized(content, counts);
  return record(kStatistics, content);
}

void McapWriter::put(std::span<const std::uint8_t> bytes) {
  errno = 0;
  if (!stream_.is_open()) stream_.open(path_, std::ios::binary | std::ios::trunc);
  stream_.write(reinterpret_cast<const char*>(bytes.data()),
                static_cast<std::streamsize>(bytes.size()));
  if (stream_.flush()) {
    position_ += bytes.size();
    crc_ = crc_of(bytes, crc_);
    return;
  }
  const int error = errno;
  ended_ = true;
  stream_.close();
  std::error_code ignored;  // a torn record at the end does no harm to readers
  std::filesystem::resize_file(path_, position_, ignored);
  throw Error(Fault::kUsage, std::string("cannot write: ") + std::strerror(error), path_.string(),
              "check the folder's permissions and the free space; what was written before can be "
              "read");
}

}  // namespace stillpoint::ros2_messages
