// Numbers and texts out of bytes, as the formats of bags and the messages in them have them.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint::bag {

using ByteSpan = std::span<const std::uint8_t>;
static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

/// How the fields of a message are laid out.
enum class Serialisation {
  kRos1,  ///< one after the other, little-endian
  kCdr,   ///< of ROS 2: aligned, after four bytes that say in which order bytes stand (OMG, XCDR1)
  kOther
};

/// Reads from front to back. Throws Error(kData) where the bytes end.
class ByteReader {
 public:
  /// Fields one after the other, little-endian.
  explicit ByteReader(ByteSpan bytes) : bytes_(bytes) {}
  /// The fields of a message. Throws Error(kData) when it is of a kind that is not read.
  ByteReader(ByteSpan message, Serialisation serialisation);

  template <class T>
  T number() {
    if (aligned_) skip((sizeof(T) - (position_ - kCdrHeader) % sizeof(T)) % sizeof(T));
    const ByteSpan bytes = take(sizeof(T));
    T value;
    std::memcpy(&value, bytes.data(), sizeof(T));
    return swapped_ ? swap(value) : value;
  }

  /// Its length, and then its letters.
  std::string text();
  /// Their number, and then bytes.
  ByteSpan byte_sequence() { return take(number<std::uint32_t>()); }
  ByteSpan take(std::size_t count);
  void skip(std::size_t count) { take(count); }

  std::size_t position() const { return position_; }
  std::size_t left() const { return bytes_.size() - position_; }

 private:
  static constexpr std::size_t kCdrHeader = 4;  // bytes, from behind which alignment counts

  template <class T>
  static T swap(T value) {
    std::uint8_t bytes[sizeof(T)], turned[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    for (std::size_t i = 0; i < sizeof(T); ++i) turned[i] = bytes[sizeof(T) - 1 - i];
    std::memcpy(&value, turned, sizeof(T));
    return value;
  }

  ByteSpan bytes_;
  std::size_t position_ = 0;
  bool aligned_ = false;
  bool swapped_ = false;
};

}  // namespace stillpoint::bag
