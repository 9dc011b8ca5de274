// Bags of ROS 2 in SQLite, with the tables of rosbag2_storage_sqlite3.
#pragma once

#include <sqlite3.h>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

#include "support/bag_style.hpp"

namespace stillpoint::testing {

class Ros2DatabaseWriter final : public BagWriter {
 public:
  Ros2DatabaseWriter(const std::filesystem::path& file, BagStyle style)
      : style_(std::move(style)), database_(nullptr, &sqlite3_close) {
    sqlite3* handle = nullptr;
    sqlite3_open(file.c_str(), &handle);
    database_.reset(handle);
    execute(
        "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
        "serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
        "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, "
        "timestamp INTEGER NOT NULL, data BLOB NOT NULL);"
        "CREATE INDEX timestamp_idx ON messages (timestamp ASC);"
        "BEGIN");
  }
  Serialisation serialisation() const override { return Serialisation::kCdr; }

  void add(const std::string& topic, const std::string& type, std::int64_t time,
           const BagBytes& message) override {
    if (!topics_.contains(topic)) {
      topics_[topic] = static_cast<int>(topics_.size() + 1);
      execute("INSERT INTO topics VALUES(" + std::to_string(topics_[topic]) + ", '" + topic +
              "', '" + ros2_type(type) + "', 'cdr', '')");
    }
    const BagBytes stored = compressed(style_.compression, message);
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(database_.get(),
                       "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1,
                       &statement, nullptr);
    sqlite3_bind_int(statement, 1, topics_[topic]);
    sqlite3_bind_int64(statement, 2, time);
    sqlite3_bind_blob64(statement, 3, stored.data(), stored.size(), SQLITE_STATIC);
    sqlite3_step(statement);
    if (sqlite3_finalize(statement) != SQLITE_OK)
      throw std::runtime_error(sqlite3_errmsg(database_.get()));
  }

  void finish() override {
    execute("COMMIT");
    database_.reset();
  }

 private:
  void execute(const std::string& sql) {
    if (sqlite3_exec(database_.get(), sql.c_str(), nullptr, nullptr, nullptr) != SQLITE_OK)
      throw std::runtime_error(sqlite3_errmsg(database_.get()));
  }

  BagStyle style_;
  std::unique_ptr<sqlite3, int (*)(sqlite3*)> database_;
  std::map<std::string, int> topics_;
};

}  // namespace stillpoint::testing
