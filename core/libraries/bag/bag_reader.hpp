// A bag: messages of many topics in one file, or in several of one folder.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "bag/byte_reader.hpp"
#include "bag/damage_list.hpp"

namespace stillpoint::bag {

struct Topic {
  std::string name;
  std::string type;      ///< as ROS 1 writes it, "sensor_msgs/Image", in bags of ROS 2, too
  std::string encoding;  ///< as the bag has it: "ros1", "cdr", "protobuf", …
  Serialisation serialisation = Serialisation::kOther;
};

/// Where a message is.
struct MessagePlace {
  std::int64_t time = 0;       ///< ns since 1970 on the recording machine's clock, of its arrival
  std::uint32_t topic = 0;     ///< index in BagReader::topics()
  std::uint32_t file = 0;      ///< of several
  std::uint32_t chunk = 0;     ///< of the file
  std::uint64_t position = 0;  ///< in the chunk
};

/// Knows where every message is from the moment it is opened. Damaged and unfinished bags are read
/// as far as they go. One per thread.
class BagReader {
 public:
  BagReader() = default;
  virtual ~BagReader() = default;
  BagReader(const BagReader&) = delete;
  BagReader& operator=(const BagReader&) = delete;

  /// "ROS 1 bag", "MCAP", "ROS 2 database".
  virtual std::string format() const = 0;
  const std::vector<Topic>& topics() const { return topics_; }
  /// In order of time.
  const std::vector<MessagePlace>& messages() const { return messages_; }
  /// What was found damaged until now: some of it shows only when messages are read.
  virtual std::vector<std::string> damage() const { return damage_.texts(); }

  /// The first `at_most` bytes of a message, all of them by default; valid until the next call.
  /// Throws Error(kData) when they cannot be read.
  virtual ByteSpan read(const MessagePlace& place,
                        std::size_t at_most = std::numeric_limits<std::size_t>::max()) = 0;

 protected:
  /// Its index; that of an earlier one with the same name, type and encoding, if any: several
  /// publishers of a topic are told apart in files.
  std::uint32_t add_topic(Topic topic);
  /// Once all are known.
  void sort_messages();

  std::vector<Topic> topics_;
  std::vector<MessagePlace> messages_;
  DamageList damage_;
};

/// A file, by its content, or a folder with such files (stillpoint::bag_files) or its
/// metadata.yaml, of which those that cannot be read are damage. Throws Error(kData) when it is no
/// bag, or nothing of it can be read.
std::unique_ptr<BagReader> open_bag(const std::filesystem::path& path);

/// "sensor_msgs/Image" of "sensor_msgs/msg/Image".
std::string ros1_type(std::string type);

/// Seconds of nanoseconds, nearest to what a text with as many digits gives.
inline double seconds(std::int64_t nanoseconds) {
  constexpr std::int64_t kSecond = 1'000'000'000;
  const std::int64_t whole = nanoseconds / kSecond;
  return static_cast<double>(whole) + static_cast<double>(nanoseconds % kSecond) * 1e-9;
}

}  // namespace stillpoint::bag
