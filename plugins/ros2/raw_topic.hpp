// Topics of DDS whose samples are serialised messages.
#pragma once

#include <dds/dds.h>

#include <string>

#include "ros2_messages/byte_writer.hpp"

namespace stillpoint::ros2 {

using ros2_messages::Bytes;

/// Messages in CDR, with its header of four bytes: a sample for dds_write() and dds_take() is a
/// `Bytes`. Samples that dds_take() lends are not supported. `type` as DDS names it. Negative: the
/// code of an error.
dds_entity_t create_raw_topic(dds_entity_t participant, const std::string& name,
                              const std::string& type);

}  // namespace stillpoint::ros2
