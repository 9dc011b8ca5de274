// The serialisation of ROS 2's messages: CDR, first version, lowest byte first (OMG DDSI-RTPS 2.2,
// 10).
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <string_view>
#include <utility>

#include "ros2_messages/byte_writer.hpp"
#include "stillpoint/error.hpp"

namespace stillpoint::ros2_messages {

/// Appends the fields of one message in the order of its definition.
class CdrWriter {
 public:
  /// Every number stands at a multiple of its size, counted from after the header.
  template <class Number>
  void number(Number value) {
    pad_to(sizeof(Number));
    append(bytes_, value);
  }
  /// The number of elements of a sequence, which follow.
  void count(std::size_t elements) {
    if (elements > std::numeric_limits<std::uint32_t>::max())
      throw Error(Fault::kStage, "a message has more elements than ROS allows, 2³² - 1");
    number(static_cast<std::uint32_t>(elements));
  }
  void text(std::string_view value) {
    count(value.size() + 1);
    append_letters(bytes_, value);
    bytes_.push_back(0);
  }
  /// Elements of a byte each, after their count().
  void raw(std::span<const std::uint8_t> bytes) { append(bytes_, bytes); }

  Bytes take() && { return std::move(bytes_); }

 private:
  static constexpr std::size_t kHeader = 4;

  void pad_to(std::size_t size) {
    while ((bytes_.size() - kHeader) % size != 0) bytes_.push_back(0);
  }

  Bytes bytes_ = {0, 1, 0, 0};  // CDR_LE, no options
};

}  // namespace stillpoint::ros2_messages
