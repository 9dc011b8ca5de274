// Bytes as bags and the messages in them have them, for tests of what reads them.
#pragma once

#include <cstdint>
#include <cstring>
#include <string>
#include <vector>

#include "bag/byte_reader.hpp"

namespace stillpoint::testing {

using bag::Serialisation;
using BagBytes = std::vector<std::uint8_t>;

/// Bytes that numbers and texts are put behind; as a message when it has a serialisation.
class ByteWriter {
 public:
  ByteWriter() = default;
  explicit ByteWriter(Serialisation serialisation) : cdr_(serialisation == Serialisation::kCdr) {
    if (cdr_) bytes_ = {0, 1, 0, 0};  // little-endian
  }

  template <class T>
  ByteWriter& number(T value) {
    while (cdr_ && (bytes_.size() - 4) % sizeof(T) != 0) bytes_.push_back(0);
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof(T));
    std::memcpy(&bytes_[at], &value, sizeof(T));
    return *this;
  }
  ByteWriter& text(const std::string& letters) {
    number(static_cast<std::uint32_t>(letters.size() + cdr_));
    raw(letters);
    if (cdr_) bytes_.push_back(0);
    return *this;
  }
  ByteWriter& sequence(const std::vector<std::uint8_t>& bytes) {
    number(static_cast<std::uint32_t>(bytes.size()));
    return raw(bytes);
  }
  template <class Range>
  ByteWriter& raw(const Range& bytes) {
    bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
    return *this;
  }
  const std::vector<std::uint8_t>& bytes() const { return bytes_; }

 private:
  bool cdr_ = false;
  std::vector<std::uint8_t> bytes_;
};

}  // namespace stillpoint::testing
