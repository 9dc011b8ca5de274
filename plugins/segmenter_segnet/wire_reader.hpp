// Protocol buffers in their binary form: one field after the other, without a schema.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace stillpoint::segmenter_segnet {

/// One field of a message. Which member holds its value depends on its wire type.
struct WireField {
  enum class Type { kVarint = 0, kFixed64 = 1, kBytes = 2, kFixed32 = 5 };
  std::uint32_t number = 0;
  Type type = Type::kVarint;
  std::uint64_t varint = 0;         ///< kVarint
  std::span<const std::byte> data;  ///< the others: the bytes of the value
};

/// Reads the fields of one message. Throws Error(kData) for invalid bytes, such as a length beyond
/// the end.
class WireReader {
 public:
  explicit WireReader(std::span<const std::byte> message) : rest_(message) {}

  /// Nothing at the end of the message.
  std::optional<WireField> next();
  /// A number by itself, as in packed fields.
  std::uint64_t varint();
  bool done() const { return rest_.empty(); }

 private:
  std::span<const std::byte> take(std::uint64_t size);

  std::span<const std::byte> rest_;
};

}  // namespace stillpoint::segmenter_segnet
