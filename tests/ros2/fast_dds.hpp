// Publishers and subscribers of Fast DDS as a node of ROS 2 has them, on the loopback interface.
#pragma once

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/DataWriterListener.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/DataReaderListener.hpp>
#include <functional>
#include <list>
#include <mutex>
#include <string>
#include <vector>

namespace stillpoint::testing {

namespace dds = eprosima::fastdds::dds;

using Payload = std::vector<char>;  // a message in CDR, with its header
constexpr std::chrono::seconds kPatience(10);

enum class Quality { kDefault, kSensorData, kTransientLocal };  // profiles of ROS 2

/// Waits for what happens on threads of DDS.
class News {
 public:
  /// False when it has not become so in time. `condition` is called with the lock of edit().
  bool wait(const std::function<bool()>& condition, std::chrono::milliseconds time = kPatience) {
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, time, condition);
  }
  void edit(const std::function<void()>& change) {
    const std::lock_guard lock(mutex_);
    change();
    changed_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable changed_;
};

class FastWriter : dds::DataWriterListener {
 public:
  FastWriter(dds::DomainParticipant& participant, const std::string& topic, const std::string& type,
             Quality quality, News& news);
  int readers() const { return readers_; }  ///< with the lock of news
  /// Waits a little until its readers have it, if they are reliable.
  void write(Payload message);

 private:
  void on_publication_matched(dds::DataWriter* writer,
                              const dds::PublicationMatchedStatus& status) override;
  News& news_;
  int readers_ = 0;
  dds::DataWriter* writer_;
};

class FastReader : dds::DataReaderListener {
 public:
  FastReader(dds::DomainParticipant& participant, const std::string& topic, const std::string& type,
             Quality quality, News& news);
  int writers() const { return writers_; }                            ///< with the lock of news
  const std::vector<Payload>& messages() const { return messages_; }  ///< with the lock of news

 private:
  void on_subscription_matched(dds::DataReader* reader,
                               const dds::SubscriptionMatchedStatus& status) override;
  void on_data_available(dds::DataReader* reader) override;
  News& news_;
  int writers_ = 0;
  std::vector<Payload> messages_;
  dds::DataReader* reader_;
};

/// A node: its topics by their names in ROS ("/tf"), types as DDS names them.
class FastNode {
 public:
  explicit FastNode(int domain);
  ~FastNode();
  FastNode(const FastNode&) = delete;
  FastNode& operator=(const FastNode&) = delete;

  FastWriter& publish(const std::string& topic, const std::string& type,
                      Quality quality = Quality::kDefault);
  FastReader& subscribe(const std::string& topic, const std::string& type,
                        Quality quality = Quality::kDefault);
  /// False when not all of them have found a partner in time.
  bool wait_for_partners();
  News& news() { return news_; }

 private:
  News news_;
  dds::DomainParticipant* participant_;
  std::list<FastWriter> writers_;
  std::list<FastReader> readers_;
};

}  // namespace stillpoint::testing
