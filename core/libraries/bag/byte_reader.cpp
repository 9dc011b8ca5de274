#include "bag/byte_reader.hpp"

namespace stillpoint::bag {

ByteReader::ByteReader(ByteSpan message, Serialisation serialisation) : bytes_(message) {
  if (serialisation == Serialisation::kRos1) return;
  if (serialisation != Serialisation::kCdr)
    throw Error(Fault::kData, "the message is neither of ROS 1 nor CDR");
  const ByteSpan kind = take(kCdrHeader);
  if (kind[0] != 0 || kind[1] > 1)
    throw Error(Fault::kData, "the message is not in plain CDR of version 1, as ROS 2 writes it");
  aligned_ = true;
  swapped_ = kind[1] == 0;
}

std::string ByteReader::text() {
  const ByteSpan letters = byte_sequence();
  std::string text(letters.begin(), letters.end());
  if (aligned_ && !text.empty()) text.pop_back();  // CDR counts the zero at the end
  return text;
}

ByteSpan ByteReader::take(std::size_t count) {
  if (count > left()) throw Error(Fault::kData, "the bytes end too early");
  const ByteSpan taken = bytes_.subspan(position_, count);
  position_ += count;
  return taken;
}

}  // namespace stillpoint::bag
