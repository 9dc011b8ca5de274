#include "ros2/raw_topic.hpp"

#include <dds/ddsi/ddsi_keyhash.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>
#include <dds/ddsi/q_radmin.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <span>

#include "ros2/dds_library.hpp"

namespace stillpoint::ros2 {
namespace {

constexpr std::size_t kUnit = 4;  // bytes, of which DDS sends multiples

// DDS counts who uses a sample; its last user calls free_data().
struct RawData : ddsi_serdata {
  RawData(const ddsi_sertype* sertype, ddsi_serdata_kind data_kind, std::size_t size)
      : bytes((size + kUnit - 1) / kUnit * kUnit) {
    ddsi_serdata_init(this, sertype, data_kind);
  }
  Bytes bytes;
};

struct RawType : ddsi_sertype {};

const Bytes& bytes_of(const ddsi_serdata* data) { return static_cast<const RawData*>(data)->bytes; }

/// The parts, one after the other; what is behind them is zero.
ddsi_serdata* joined(const ddsi_sertype* type, ddsi_serdata_kind kind, std::size_t size,
                     std::span<const ddsrt_iovec_t> parts) {
  auto data = std::make_unique<RawData>(type, kind, size);
  std::size_t end = 0;
  for (const ddsrt_iovec_t& part : parts) {
    const std::size_t count = std::min<std::size_t>(part.iov_len, size - end);
    std::memcpy(data->bytes.data() + end, part.iov_base, count);
    end += count;
  }
  return data.release();
}

/// Fragments are in order, and may overlap.
ddsi_serdata* from_fragments(const ddsi_sertype* type, ddsi_serdata_kind kind,
                             const nn_rdata* fragment, std::size_t size) {
  auto data = std::make_unique<RawData>(type, kind, size);
  std::uint32_t end = 0;
  for (; fragment; fragment = fragment->nextfrag) {
    if (fragment->maxp1 <= end || fragment->maxp1 > size) continue;
    const unsigned char* payload =
        NN_RMSG_PAYLOADOFF(fragment->rmsg, NN_RDATA_PAYLOAD_OFF(fragment));
    std::memcpy(data->bytes.data() + end, payload + (end - fragment->min), fragment->maxp1 - end);
    end = fragment->maxp1;
  }
  return data.release();
}

ddsi_serdata* from_parts(const ddsi_sertype* type, ddsi_serdata_kind kind, ddsrt_msg_iovlen_t count,
                         const ddsrt_iovec_t* parts, std::size_t size) {
  return joined(type, kind, size, {parts, count});
}

ddsi_serdata* from_sample(const ddsi_sertype* type, ddsi_serdata_kind kind, const void* sample) {
  if (kind != SDK_DATA) return new RawData(type, kind, kUnit);
  const Bytes& bytes = *static_cast<const Bytes*>(sample);
  const ddsrt_iovec_t whole{.iov_base = const_cast<std::uint8_t*>(bytes.data()),
                            .iov_len = bytes.size()};
  return joined(type, kind, bytes.size(), {&whole, 1});
}

void to_bytes(const ddsi_serdata* data, std::size_t offset, std::size_t size, void* to) {
  std::memcpy(to, bytes_of(data).data() + offset, size);
}

ddsi_serdata* to_reference(const ddsi_serdata* data, std::size_t offset, std::size_t size,
                           ddsrt_iovec_t* reference) {
  reference->iov_base = const_cast<std::uint8_t*>(bytes_of(data).data() + offset);
  reference->iov_len = size;
  return ddsi_serdata_ref(data);
}

bool to_sample(const ddsi_serdata* data, void* sample, void** buffer, void*) {
  if (buffer) return false;
  *static_cast<Bytes*>(sample) = bytes_of(data);
  return true;
}

// There are no keys: all samples of a topic are of one instance.
constexpr ddsi_serdata_ops kDataOperations{
    .eqkey = [](const ddsi_serdata*, const ddsi_serdata*) { return true; },
    .get_size =
        [](const ddsi_serdata* data) { return static_cast<std::uint32_t>(bytes_of(data).size()); },
    .from_ser = from_fragments,
    .from_ser_iov = from_parts,
    .from_keyhash = [](const ddsi_sertype* type, const ddsi_keyhash*) -> ddsi_serdata* {
      return new RawData(type, SDK_KEY, kUnit);
    },
    .from_sample = from_sample,
    .to_ser = to_bytes,
    .to_ser_ref = to_reference,
    .to_ser_unref = [](ddsi_serdata* data, const ddsrt_iovec_t*) { ddsi_serdata_unref(data); },
    .to_sample = to_sample,
    .to_untyped = [](const ddsi_serdata* data) -> ddsi_serdata* {
      auto* untyped = new RawData(data->type, SDK_KEY, kUnit);
      untyped->type = nullptr;
      return untyped;
    },
    .untyped_to_sample =
        [](const ddsi_sertype*, const ddsi_serdata*, void* sample, void**, void*) {
          static_cast<Bytes*>(sample)->clear();
          return true;
        },
    .free = [](ddsi_serdata* data) { delete static_cast<RawData*>(data); },
    .print = [](const ddsi_sertype*, const ddsi_serdata*, char* text,
                std::size_t size) -> std::size_t {
      if (size > 0) text[0] = '\0';  // in traces
      return 0;
    },
    .get_keyhash = [](const ddsi_serdata*, ddsi_keyhash* hash,
                      bool) { std::memset(hash, 0, sizeof(*hash)); }};

const ddsi_sertype_ops& type_operations() {
  static const ddsi_sertype_ops operations{
      .version = dds_library().function<void(struct ddsi_sertype_v0*)>("ddsi_sertype_v0"),
      .free =
          [](ddsi_sertype* type) {
            ddsi_sertype_fini(type);
            delete static_cast<RawType*>(type);
          },
      .equal = [](const ddsi_sertype*, const ddsi_sertype*) { return true; },  // names are compared
      .hash = [](const ddsi_sertype*) { return std::uint32_t{0}; }};
  return operations;
}

}  // namespace

dds_entity_t create_raw_topic(dds_entity_t participant, const std::string& name,
                              const std::string& type) {
  auto raw = std::make_unique<RawType>();
  ddsi_sertype_init_flags(raw.get(), type.c_str(), &type_operations(), &kDataOperations,
                          DDSI_SERTYPE_FLAG_TOPICKIND_NO_KEY);
  raw->allowed_data_representation = DDS_DATA_REPRESENTATION_FLAG_XCDR1;
  ddsi_sertype* sertype = raw.get();
  const dds_entity_t topic =
      dds_create_topic_sertype(participant, name.c_str(), &sertype, nullptr, nullptr, nullptr);
  if (topic < 0)
    ddsi_sertype_fini(raw.get());
  else
    static_cast<void>(raw.release());  // DDS's from now on
  return topic;
}

}  // namespace stillpoint::ros2
