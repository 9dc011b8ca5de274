// Writes MCAP files (https://mcap.dev/spec), the container of ROS 2's bags and of Foxglove.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "ros2_messages/byte_writer.hpp"
#include "ros2_messages/compression.hpp"
#include "ros2_messages/messages.hpp"

namespace stillpoint::ros2_messages {

using ChannelId = std::uint16_t;

/// Messages of ROS 2 in chunks of about a megabyte or a second. Each chunk is handed to the system
/// when it is full: whenever the process ends, readers find all messages up to the last chunk. One
/// thread at a time.
///
/// Throws Error(kUsage) when the file cannot be written, once: what comes after that is ignored,
/// and the file ends with the last whole record.
class McapWriter {
 public:
  /// Replaces a file of that name, once there is something to write.
  explicit McapWriter(std::filesystem::path file, Compression compression = Compression::kZstd);
  /// Finishes a file with messages where finish() was not called; what then goes wrong stays
  /// unsaid.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// For messages of one type under a name such as "/tf".
  template <class Message>
  ChannelId add_channel(const std::string& topic) {
    return add_channel(topic, Message::kType);
  }
  /// `time` in seconds, of what the message is about.
  template <class Message>
  void write(ChannelId channel, double time, const Message& message) {
    write(channel, nanoseconds(time), cdr_of(message));
  }

  /// Writes what is left and the summary: indices of all messages, statistics. Once.
  void finish();

 private:
  static constexpr std::uint64_t kNoTime = std::numeric_limits<std::uint64_t>::max();

  struct TimeRange {
    std::uint64_t first = kNoTime;  // ns
    std::uint64_t last = 0;

    void add(std::uint64_t time);
    std::uint64_t start() const { return first == kNoTime ? 0 : first; }
  };
  struct Channel {
    Bytes record;
    std::uint32_t messages = 0;
    std::vector<std::pair<std::uint64_t, std::uint64_t>> index;  // of the chunk: time, offset
  };

  ChannelId add_channel(const std::string& topic, const std::string& type);
  std::uint16_t schema_of(const std::string& type);
  void write(ChannelId channel, std::uint64_t time, const Bytes& data);
  void end_chunk();
  void append_message_indices(Bytes& out, Bytes& offsets, std::uint64_t at);
  Bytes summary(std::uint64_t begin) const;
  Bytes statistics() const;
  void put(std::span<const std::uint8_t> bytes);

  std::filesystem::path path_;
  Compression compression_;
  std::ofstream stream_;
  std::uint64_t position_ = 0;  // in the file
  std::uint32_t crc_ = 0;       // of the file so far
  bool ended_ = false;          // finished or failed
  std::map<std::string, std::uint16_t> schemas_;
  std::vector<Bytes> schema_records_;
  std::vector<Channel> channels_;
  Bytes chunk_;  // not yet compressed
  TimeRange chunk_times_, times_;
  std::vector<Bytes> chunk_indices_;
  std::uint64_t messages_ = 0;
};

}  // namespace stillpoint::ros2_messages
