// A participant of DDS with the names of topics and types, and the quality of service, of ROS 2.
#pragma once

#include <dds/dds.h>

#include <chrono>
#include <optional>
#include <stop_token>
#include <string>
#include <string_view>

#include "ros2/raw_topic.hpp"

namespace stillpoint::ros2 {

/// "rt/camera/image" of "/camera/image" or "camera/image".
std::string dds_topic(std::string_view topic);
/// "sensor_msgs::msg::dds_::Image_" of "sensor_msgs/Image".
std::string dds_type(std::string_view type);

/// Thread-safe, as all of DDS.
class Participant {
 public:
  /// In this domain; negative: that of ROS_DOMAIN_ID, or 0. With ROS_LOCALHOST_ONLY=1, on the
  /// loopback interface alone, without multicast. Everything else is as CYCLONEDDS_URI has it.
  /// Throws Error(kUsage) when DDS is not installed or cannot be started.
  explicit Participant(int domain);
  /// Its writers and readers end with it.
  ~Participant();
  Participant(const Participant&) = delete;
  Participant& operator=(const Participant&) = delete;

  dds_entity_t id() const { return id_; }

 private:
  dds_entity_t id_;
};

/// How long a writer keeps its messages.
enum class Kept {
  kShortly,  ///< ten of them, for readers that are there: ROS's default
  kLast      ///< the last one, for readers that come later, too: maps, states
};

/// Reliable.
class Writer {
 public:
  /// Throws Error(kUsage) for a name that DDS refuses.
  Writer(const Participant& participant, const std::string& topic, std::string_view type,
         Kept kept);

  /// Somebody reads.
  bool wanted() const;
  /// False when readers are so slow that there is no room for the message.
  bool write(const Bytes& message) const;
  /// Until all readers have what was written, at most this long.
  void wait_for_readers(std::chrono::milliseconds at_most) const;

 private:
  std::string topic_;
  dds_entity_t id_;
};

class Reader {
 public:
  /// Keeps the last `depth` messages; a `reliable` one refuses writers that are not. With kLast it
  /// also gets what writers of that kind had written before, and refuses others. Throws as Writer.
  Reader(const Participant& participant, const std::string& topic, std::string_view type, int depth,
         bool reliable, Kept kept = Kept::kShortly);

  const std::string& topic() const { return topic_; }
  /// Writers that are known.
  int writers() const;
  /// The next message, waiting for it until then, or until a stop is requested.
  std::optional<Bytes> take(std::chrono::steady_clock::time_point deadline,
                            const std::stop_token& stop = {}) const;

 private:
  std::string topic_;
  dds_entity_t id_;
  dds_entity_t waitset_;
};

}  // namespace stillpoint::ros2
