// Numbers and texts as bytes, lowest byte first.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>
#include <type_traits>
#include <vector>

namespace stillpoint::ros2_messages {

using Bytes = std::vector<std::uint8_t>;
static_assert(std::endian::native == std::endian::little, "numbers are copied as they are");

inline void append(Bytes& out, std::span<const std::uint8_t> bytes) {
  out.insert(out.end(), bytes.begin(), bytes.end());
}

template <class Number>
requires std::is_arithmetic_v<Number>
void append(Bytes& out, Number number) {
  const std::size_t end = out.size();
  out.resize(end + sizeof(Number));
  std::memcpy(&out[end], &number, sizeof(Number));
}

/// The bytes of a text, without its length.
inline void append_letters(Bytes& out, std::string_view text) {
  out.insert(out.end(), text.begin(), text.end());
}

}  // namespace stillpoint::ros2_messages
