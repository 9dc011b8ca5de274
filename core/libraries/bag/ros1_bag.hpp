// Bags of ROS 1, version 2.0 (https://wiki.ros.org/Bags/Format/2.0).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "bag/bag_reader.hpp"
#include "bag/chunks.hpp"

namespace stillpoint::bag {

inline constexpr std::string_view kRos1Magic = "#ROSBAG V2.0\n";

/// Goes from record to record. The index records behind a chunk list its messages; where there are
/// none, because the recording was cut off, the chunk itself is read.
class Ros1Bag final : public BagReader {
 public:
  explicit Ros1Bag(const std::filesystem::path& file);

  std::string format() const override { return "ROS 1 bag"; }
  ByteSpan read(const MessagePlace& place, std::size_t at_most) override;

 private:
  struct Record;
  std::optional<Record> record_at(std::uint32_t chunk, std::uint64_t offset);
  void read_index(std::uint64_t begin);
  void read_file();
  std::uint64_t read_chunk(const Record& record);
  std::optional<std::uint32_t> add_chunk(const Record& record, std::uint64_t limit);
  bool add_indexed(const Record& record, std::uint32_t chunk);
  void scan(std::uint32_t chunk);
  void add_connection(std::uint32_t chunk, const Record& record);
  void add_message(std::uint32_t chunk, const Record& record);

  Chunks chunks_;
  std::unordered_map<std::uint32_t, std::uint32_t> topic_of_;  // by number of the connection
};

}  // namespace stillpoint::bag
