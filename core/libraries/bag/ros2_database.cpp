#include "bag/ros2_database.hpp"

namespace stillpoint::bag {

Ros2Database::Ros2Database(const std::filesystem::path& file) : file_(file), database_(file) {
  read_topics();
  read_messages();
  sort_messages();
}

void Ros2Database::read_topics() {
  const std::string fault = database_.for_each(
      "SELECT id, name, type, serialization_format FROM topics", [&](const SqliteReader::Row& row) {
        topic_of_[row.integer(0)] = static_cast<std::uint32_t>(topics_.size());
        Topic topic{.name = row.text(1), .type = ros1_type(row.text(2)), .encoding = row.text(3)};
        if (topic.encoding == "cdr") topic.serialisation = Serialisation::kCdr;
        topics_.push_back(std::move(topic));
        return true;
      });
  if (!fault.empty() && topics_.empty())
    throw Error(Fault::kData, "is no bag of ROS 2: " + fault, file_.string());
  if (!fault.empty()) damage_.add("the table of topics: " + fault);
}

/// From the front, and where that ends at a damaged page, from the back.
void Ros2Database::read_messages() {
  const std::string query = "SELECT rowid, topic_id, timestamp FROM messages ORDER BY rowid";
  std::int64_t last = -1;
  const auto add = [&](const SqliteReader::Row& row) {
    const auto topic = topic_of_.find(row.integer(1));
    if (topic != topic_of_.end())
      messages_.push_back(
          {row.integer(2), topic->second, 0, 0, static_cast<std::uint64_t>(row.integer(0))});
  };
  const std::string fault = database_.for_each(query, [&](const SqliteReader::Row& row) {
    last = row.integer(0);
    add(row);
    return true;
  });
  if (fault.empty()) return;
  damage_.add("the table of messages is damaged behind row " + std::to_string(last) + ": " + fault);
  database_.for_each(query + " DESC", [&](const SqliteReader::Row& row) {
    if (row.integer(0) <= last) return false;
    add(row);
    return true;
  });
}

ByteSpan Ros2Database::read(const MessagePlace& place, std::size_t at_most) {
  const auto row = static_cast<std::int64_t>(place.position);
  return message_.first(
      at_most, file_.string() + ": row " + std::to_string(row),
      [&](std::size_t count) { return database_.blob("messages", "data", row, count); });
}

}  // namespace stillpoint::bag
