// Bags of ROS 2 in a SQLite database (rosbag2_storage_sqlite3).
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_map>

#include "bag/bag_reader.hpp"
#include "bag/compression.hpp"
#include "bag/sqlite_reader.hpp"

namespace stillpoint::bag {

/// One .db3 file.
class Ros2Database final : public BagReader {
 public:
  explicit Ros2Database(const std::filesystem::path& file);

  std::string format() const override { return "ROS 2 database"; }
  ByteSpan read(const MessagePlace& place, std::size_t at_most) override;

 private:
  void read_topics();
  void read_messages();

  std::filesystem::path file_;
  SqliteReader database_;
  std::unordered_map<std::int64_t, std::uint32_t> topic_of_;  // by its key in the database
  MessageBytes message_;
};

}  // namespace stillpoint::bag
