// MCAP files (https://mcap.dev/spec), as ROS 2 and Foxglove write them.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "bag/bag_reader.hpp"
#include "bag/chunks.hpp"

namespace stillpoint::bag {

inline constexpr std::string_view kMcapMagic = "\x89MCAP0\r\n";

/// Goes from record to record. The index records behind a chunk list its messages; where there are
/// none, the chunk itself is read.
class McapFile final : public BagReader {
 public:
  explicit McapFile(const std::filesystem::path& file);

  std::string format() const override { return "MCAP"; }
  ByteSpan read(const MessagePlace& place, std::size_t at_most) override;

 private:
  struct Record;
  std::optional<Record> record_at(std::uint32_t chunk, std::uint64_t offset);
  ByteReader content(std::uint32_t chunk, const Record& record);
  void read_summary();
  void read_data();
  std::uint64_t read_chunk(const Record& record);
  std::optional<std::uint32_t> add_chunk(const Record& record, std::uint64_t limit);
  bool add_indexed(const Record& record, std::uint32_t chunk);
  void scan(std::uint32_t chunk);
  void read_small_record(std::uint32_t chunk, const Record& record);
  void add_channel(ByteReader reader);

  Chunks chunks_;
  std::unordered_map<std::uint16_t, std::string> type_of_;     // by number of the schema
  std::unordered_map<std::uint16_t, std::uint32_t> topic_of_;  // by number of the channel
  MessageBytes message_;
};

}  // namespace stillpoint::bag
