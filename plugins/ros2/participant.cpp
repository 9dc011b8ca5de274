#include "ros2/participant.hpp"

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <limits>
#include <memory>

#include "ros2/dds_library.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::ros2 {
namespace {

constexpr int kLastDomain = 232;                         // later ones have no ports
constexpr dds_duration_t kMaxBlocking = DDS_MSECS(100);  // of writers with readers that are slow
constexpr int kShortHistory = 10;                        // messages
constexpr dds_duration_t kLongestWait = DDS_MSECS(100);  // until a stop is noticed

// Participants find each other by their ports, of which the first 32 are tried.
constexpr const char* kLoopbackOnly =
    "<CycloneDDS><Domain>"
    "<General><Interfaces><NetworkInterface address=\"127.0.0.1\" multicast=\"false\"/>"
    "</Interfaces><AllowMulticast>false</AllowMulticast></General>"
    "<Discovery><ParticipantIndex>auto</ParticipantIndex>"
    "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex>"
    "<Peers><Peer address=\"127.0.0.1\"/></Peers></Discovery></Domain></CycloneDDS>";

std::string variable(const char* name) {
  const char* value = std::getenv(name);
  return value ? value : "";
}

dds_domainid_t domain_of(int option) {
  const std::string text = variable("ROS_DOMAIN_ID");
  if (option >= 0) return static_cast<dds_domainid_t>(option);
  if (text.empty()) return 0;
  int domain = -1;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), domain);
  if (read.ec != std::errc{} || read.ptr != text.data() + text.size() || domain < 0 ||
      domain > kLastDomain)
    throw Error(Fault::kUsage, "'" + text + "' is no domain of ROS 2", "ROS_DOMAIN_ID",
                "give a number from 0 to " + std::to_string(kLastDomain));
  return static_cast<dds_domainid_t>(domain);
}

dds_entity_t required(dds_return_t result, const std::string& what, const std::string& where,
                      const std::string& advice = {}) {
  if (result < 0) throw Error(Fault::kUsage, what + ": " + dds_strretcode(result), where, advice);
  return result;
}

/// The domain stays until the process ends: it is shared by all its participants here.
void configure_loopback(dds_domainid_t domain) {
  if (variable("ROS_LOCALHOST_ONLY") != "1") return;
  const std::string given = variable("CYCLONEDDS_URI");
  const std::string config = given.empty() ? kLoopbackOnly : given + "," + kLoopbackOnly;
  const dds_return_t result = dds_create_domain(domain, config.c_str());
  if (result != DDS_RETCODE_PRECONDITION_NOT_MET)  // which is so when there is one already
    required(result, "DDS cannot be started on the loopback interface", "ROS_LOCALHOST_ONLY",
             "see what CYCLONEDDS_URI says");
}

using Quality = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;

Quality quality(dds_reliability_kind_t reliability, dds_durability_kind_t durability, int depth) {
  Quality qos(dds_create_qos(), &dds_delete_qos);
  dds_qset_reliability(qos.get(), reliability, kMaxBlocking);
  dds_qset_durability(qos.get(), durability);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
  return qos;
}

dds_entity_t topic_of(const Participant& participant, const std::string& topic,
                      std::string_view type) {
  return required(create_raw_topic(participant.id(), dds_topic(topic), dds_type(type)),
                  "DDS refuses the topic", topic,
                  "names are letters, digits and '_', with '/' between them");
}

}  // namespace

std::string dds_topic(std::string_view topic) {
  return (topic.starts_with('/') ? "rt" : "rt/") + std::string(topic);
}

std::string dds_type(std::string_view type) {
  const std::size_t slash = type.find('/');
  return std::string(type.substr(0, slash)) +
         "::msg::dds_::" + std::string(type.substr(slash + 1)) + "_";
}

Participant::Participant(int domain) {
  const dds_domainid_t number = domain_of(domain);
  configure_loopback(number);
  id_ = required(dds_create_participant(number, nullptr, nullptr), "DDS cannot be started",
                 "domain " + std::to_string(number),
                 "see whether there is a network, and what CYCLONEDDS_URI says");
}

Participant::~Participant() {
  try {
    dds_delete(id_);
  } catch (const Error&) {
    // A library without this function: the process ends what was begun.
  }
}

Writer::Writer(const Participant& participant, const std::string& topic, std::string_view type,
               Kept kept)
    : topic_(topic) {
  const bool last = kept == Kept::kLast;
  const Quality qos = quality(DDS_RELIABILITY_RELIABLE,
                              last ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE,
                              last ? 1 : kShortHistory);
  id_ = required(
      dds_create_writer(participant.id(), topic_of(participant, topic, type), qos.get(), nullptr),
      "DDS makes no writer", topic);
}

bool Writer::wanted() const { return dds_get_matched_subscriptions(id_, nullptr, 0) > 0; }

bool Writer::write(const Bytes& message) const {
  const dds_return_t result = dds_write(id_, &message);
  if (result == DDS_RETCODE_TIMEOUT) return false;
  required(result, "DDS does not take a message", topic_);
  return true;
}

void Writer::wait_for_readers(std::chrono::milliseconds at_most) const {
  dds_wait_for_acks(id_, std::max<dds_duration_t>(0, DDS_MSECS(at_most.count())));
}

Reader::Reader(const Participant& participant, const std::string& topic, std::string_view type,
               int depth, bool reliable, Kept kept)
    : topic_(topic) {
  const Quality qos = quality(
      reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
      kept == Kept::kLast ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE, depth);
  id_ = required(
      dds_create_reader(participant.id(), topic_of(participant, topic, type), qos.get(), nullptr),
      "DDS makes no reader", topic);
  waitset_ = required(dds_create_waitset(participant.id()), "DDS cannot wait", topic);
  const dds_entity_t messages =
      required(dds_create_readcondition(id_, DDS_ANY_STATE), "DDS cannot wait", topic);
  required(dds_waitset_attach(waitset_, messages, 0), "DDS cannot wait", topic);
}

int Reader::writers() const { return std::max(0, dds_get_matched_publications(id_, nullptr, 0)); }

std::optional<Bytes> Reader::take(std::chrono::steady_clock::time_point deadline,
                                  const std::stop_token& stop) const {
  while (!stop.stop_requested()) {
    Bytes message;
    void* sample = &message;
    dds_sample_info_t info;
    const dds_return_t taken = required(dds_take(id_, &sample, &info, 1, 1), "DDS fails", topic_);
    if (taken > 0 && info.valid_data) return message;
    if (taken > 0) continue;  // a writer has gone
    const auto left = std::chrono::duration_cast<std::chrono::nanoseconds>(
        deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) break;
    required(dds_waitset_wait(waitset_, nullptr, 0, std::min(left.count(), kLongestWait)),
             "DDS fails", topic_);
  }
  return std::nullopt;
}

}  // namespace stillpoint::ros2
