// The functions of Cyclone DDS that the plugin calls.
#include "ros2/dds_library.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <dds/ddsi/ddsi_sertype.h>

namespace stillpoint::ros2 {

const live_camera::DriverLibrary& dds_library() {
  static const live_camera::DriverLibrary library("libddsc.so.0debian", "libddsc0debian");
  return library;
}

}  // namespace stillpoint::ros2

#define FORWARD(name, parameters, arguments) \
  STILLPOINT_FORWARD_TO_DRIVER(stillpoint::ros2::dds_library, name, parameters, arguments)

FORWARD(dds_create_domain, (dds_domainid_t domain, const char* config), (domain, config))
FORWARD(dds_create_participant,
        (dds_domainid_t domain, const dds_qos_t* qos, const dds_listener_t* listener),
        (domain, qos, listener))
FORWARD(dds_create_topic_sertype,
        (dds_entity_t participant, const char* name, ddsi_sertype** type, const dds_qos_t* qos,
         const dds_listener_t* listener, const ddsi_plist* plist),
        (participant, name, type, qos, listener, plist))
FORWARD(dds_create_reader,
        (dds_entity_t participant, dds_entity_t topic, const dds_qos_t* qos,
         const dds_listener_t* listener),
        (participant, topic, qos, listener))
FORWARD(dds_create_writer,
        (dds_entity_t participant, dds_entity_t topic, const dds_qos_t* qos,
         const dds_listener_t* listener),
        (participant, topic, qos, listener))
FORWARD(dds_delete, (dds_entity_t entity), (entity))
FORWARD(dds_strretcode, (dds_return_t code), (code))

FORWARD(dds_create_qos, (), ())
FORWARD(dds_delete_qos, (dds_qos_t * qos), (qos))
FORWARD(dds_qset_reliability,
        (dds_qos_t * qos, dds_reliability_kind_t kind, dds_duration_t max_blocking),
        (qos, kind, max_blocking))
FORWARD(dds_qset_durability, (dds_qos_t * qos, dds_durability_kind_t kind), (qos, kind))
FORWARD(dds_qset_history, (dds_qos_t * qos, dds_history_kind_t kind, int32_t depth),
        (qos, kind, depth))

FORWARD(dds_write, (dds_entity_t writer, const void* sample), (writer, sample))
FORWARD(dds_wait_for_acks, (dds_entity_t writer, dds_duration_t timeout), (writer, timeout))
FORWARD(dds_get_matched_subscriptions,
        (dds_entity_t writer, dds_instance_handle_t* readers, size_t count),
        (writer, readers, count))
FORWARD(dds_get_matched_publications,
        (dds_entity_t reader, dds_instance_handle_t* writers, size_t count),
        (reader, writers, count))

FORWARD(dds_take,
        (dds_entity_t reader, void** samples, dds_sample_info_t* infos, size_t size,
         uint32_t count),
        (reader, samples, infos, size, count))
FORWARD(dds_create_readcondition, (dds_entity_t reader, uint32_t mask), (reader, mask))
FORWARD(dds_create_waitset, (dds_entity_t participant), (participant))
FORWARD(dds_waitset_attach, (dds_entity_t waitset, dds_entity_t entity, dds_attach_t tag),
        (waitset, entity, tag))
FORWARD(dds_waitset_wait,
        (dds_entity_t waitset, dds_attach_t* tags, size_t count, dds_duration_t timeout),
        (waitset, tags, count, timeout))

FORWARD(ddsi_serdata_init, (ddsi_serdata * data, const ddsi_sertype* type, ddsi_serdata_kind kind),
        (data, type, kind))
FORWARD(ddsi_sertype_init_flags,
        (ddsi_sertype * type, const char* name, const ddsi_sertype_ops* type_ops,
         const ddsi_serdata_ops* data_ops, uint32_t flags),
        (type, name, type_ops, data_ops, flags))
FORWARD(ddsi_sertype_fini, (ddsi_sertype * type), (type))

#undef FORWARD
