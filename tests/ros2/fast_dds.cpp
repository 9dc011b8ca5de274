#include "ros2/fast_dds.hpp"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>
#include <fastrtps/utils/IPLocator.h>
#include <algorithm>
#include <cstring>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <memory>
#include <stdexcept>

namespace stillpoint::testing {
namespace {

using eprosima::fastrtps::rtps::SerializedPayload_t;

/// Samples are serialised already.
class RawType : public dds::TopicDataType {
 public:
  explicit RawType(const std::string& name) {
    setName(name.c_str());
    m_typeSize = 1024;  // to begin with
    auto_fill_type_object(false);
    auto_fill_type_information(false);
  }
  bool serialize(void* data, SerializedPayload_t* payload) override {
    const Payload& bytes = *static_cast<const Payload*>(data);
    payload->encapsulation = CDR_LE;
    payload->length = static_cast<std::uint32_t>(bytes.size());
    std::memcpy(payload->data, bytes.data(), bytes.size());
    return true;
  }
  bool deserialize(SerializedPayload_t* payload, void* data) override {
    const char* bytes = reinterpret_cast<const char*>(payload->data);
    *static_cast<Payload*>(data) = Payload(bytes, bytes + payload->length);
    return true;
  }
  std::function<std::uint32_t()> getSerializedSizeProvider(void* data) override {
    return [data] { return static_cast<std::uint32_t>(static_cast<const Payload*>(data)->size()); };
  }
  void* createData() override { return new Payload; }
  void deleteData(void* data) override { delete static_cast<Payload*>(data); }
  bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

/// The same names for all nodes of ROS 2.
dds::Topic* topic_of(dds::DomainParticipant& participant, const std::string& topic,
                     const std::string& type) {
  dds::TypeSupport(new RawType(type)).register_type(&participant);
  return participant.create_topic("rt" + topic, type, dds::TOPIC_QOS_DEFAULT);
}

template <class Qos>
void set(Qos& qos, Quality quality) {
  qos.reliability().kind = quality == Quality::kSensorData ? dds::BEST_EFFORT_RELIABILITY_QOS
                                                           : dds::RELIABLE_RELIABILITY_QOS;
  qos.durability().kind = quality == Quality::kTransientLocal ? dds::TRANSIENT_LOCAL_DURABILITY_QOS
                                                              : dds::VOLATILE_DURABILITY_QOS;
  qos.history().kind = dds::KEEP_LAST_HISTORY_QOS;
  qos.history().depth = 100;
  qos.endpoint().history_memory_policy =
      eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
}

template <class Entity>
Entity* required(Entity* entity) {
  if (!entity) throw std::runtime_error("Fast DDS makes no entity");
  return entity;
}

}  // namespace

FastWriter::FastWriter(dds::DomainParticipant& participant, const std::string& topic,
                       const std::string& type, Quality quality, News& news)
    : news_(news) {
  dds::DataWriterQos qos = dds::DATAWRITER_QOS_DEFAULT;
  set(qos, quality);
  qos.publish_mode().kind = dds::SYNCHRONOUS_PUBLISH_MODE;
  qos.reliable_writer_qos().times.heartbeatPeriod = {0, 20'000'000};  // ns
  dds::Publisher* publisher = required(participant.create_publisher(dds::PUBLISHER_QOS_DEFAULT));
  writer_ = required(publisher->create_datawriter(topic_of(participant, topic, type), qos, this));
}

void FastWriter::write(Payload message) {
  if (!writer_->write(&message)) throw std::runtime_error("Fast DDS does not write");
  // So that no more is under way than buffers of the system hold. Readers that know the writer not
  // yet do not answer.
  writer_->wait_for_acknowledgments({0, 300'000'000});  // ns
}

void FastWriter::on_publication_matched(dds::DataWriter*,
                                        const dds::PublicationMatchedStatus& status) {
  news_.edit([&] { readers_ = status.current_count; });
}

FastReader::FastReader(dds::DomainParticipant& participant, const std::string& topic,
                       const std::string& type, Quality quality, News& news)
    : news_(news) {
  dds::DataReaderQos qos = dds::DATAREADER_QOS_DEFAULT;
  set(qos, quality);
  dds::Subscriber* subscriber =
      required(participant.create_subscriber(dds::SUBSCRIBER_QOS_DEFAULT));
  reader_ = required(subscriber->create_datareader(topic_of(participant, topic, type), qos, this));
}

void FastReader::on_subscription_matched(dds::DataReader*,
                                         const dds::SubscriptionMatchedStatus& status) {
  news_.edit([&] { writers_ = status.current_count; });
}

void FastReader::on_data_available(dds::DataReader* reader) {
  Payload message;
  dds::SampleInfo info;
  while (reader->take_next_sample(&message, &info) == ReturnCode_t::RETCODE_OK)
    if (info.valid_data) news_.edit([&] { messages_.push_back(message); });
}

FastNode::FastNode(int domain) {
  dds::DomainParticipantQos qos = dds::PARTICIPANT_QOS_DEFAULT;
  qos.transport().use_builtin_transports = false;
  auto loopback = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
  loopback->interfaceWhiteList = {"127.0.0.1"};
  qos.transport().user_transports.push_back(loopback);
  eprosima::fastrtps::rtps::Locator_t peer;
  eprosima::fastrtps::rtps::IPLocator::setIPv4(peer, "127.0.0.1");
  qos.wire_protocol().builtin.initialPeersList.push_back(peer);
  participant_ = required(dds::DomainParticipantFactory::get_instance()->create_participant(
      static_cast<dds::DomainId_t>(domain), qos));
}

FastNode::~FastNode() {
  participant_->delete_contained_entities();
  dds::DomainParticipantFactory::get_instance()->delete_participant(participant_);
}

FastWriter& FastNode::publish(const std::string& topic, const std::string& type, Quality quality) {
  return writers_.emplace_back(*participant_, topic, type, quality, news_);
}

FastReader& FastNode::subscribe(const std::string& topic, const std::string& type,
                                Quality quality) {
  return readers_.emplace_back(*participant_, topic, type, quality, news_);
}

bool FastNode::wait_for_partners() {
  return news_.wait([this] {
    return std::ranges::all_of(writers_, [](const auto& each) { return each.readers() > 0; }) &&
           std::ranges::all_of(readers_, [](const auto& each) { return each.writers() > 0; });
  });
}

}  // namespace stillpoint::testing
