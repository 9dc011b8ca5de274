#include "segmenter_segnet/wire_reader.hpp"

#include "stillpoint/error.hpp"

namespace stillpoint::segmenter_segnet {

std::uint64_t WireReader::varint() {
  std::uint64_t value = 0;
  for (int shift = 0; shift < 64; shift += 7) {
    const auto byte = std::to_integer<std::uint64_t>(take(1)[0]);
    value |= (byte & 0x7f) << shift;
    if (byte < 0x80) return value;
  }
  throw Error(Fault::kData, "it holds a number without an end");
}

std::span<const std::byte> WireReader::take(std::uint64_t size) {
  if (size > rest_.size()) throw Error(Fault::kData, "it ends in the middle of a field");
  const auto taken = rest_.first(size);
  rest_ = rest_.subspan(size);
  return taken;
}

std::optional<WireField> WireReader::next() {
  if (done()) return std::nullopt;
  const std::uint64_t key = varint();
  WireField field{.number = static_cast<std::uint32_t>(key >> 3),
                  .type = static_cast<WireField::Type>(key & 7)};
  switch (field.type) {
    case WireField::Type::kVarint:
      field.varint = varint();
      return field;
    case WireField::Type::kFixed64:
      field.data = take(8);
      return field;
    case WireField::Type::kBytes:
      field.data = take(varint());
      return field;
    case WireField::Type::kFixed32:
      field.data = take(4);
      return field;
  }
  throw Error(Fault::kData, "it holds a field of an unknown kind");
}

}  // namespace stillpoint::segmenter_segnet
