// What the writers of bags share.
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <cstdint>
#include <string>

#include "support/bag_bytes.hpp"

namespace stillpoint::testing {

inline BagBytes compressed(const std::string& compression, const BagBytes& bytes) {
  BagBytes result(2 * bytes.size() + (1 << 17));
  if (compression == "bz2") {
    auto size = static_cast<unsigned>(result.size());
    BZ2_bzBuffToBuffCompress(reinterpret_cast<char*>(result.data()), &size,
                             reinterpret_cast<char*>(const_cast<std::uint8_t*>(bytes.data())),
                             static_cast<unsigned>(bytes.size()), 1, 0, 0);
    result.resize(size);
  } else if (compression == "lz4") {
    result.resize(
        LZ4F_compressFrame(result.data(), result.size(), bytes.data(), bytes.size(), nullptr));
  } else if (compression == "zstd") {
    result.resize(ZSTD_compress(result.data(), result.size(), bytes.data(), bytes.size(), 1));
  } else {
    return bytes;
  }
  return result;
}

/// Messages in, a file out.
class BagWriter {
 public:
  virtual ~BagWriter() = default;
  virtual Serialisation serialisation() const = 0;
  /// `time` in ns; `type` as ROS 1 writes it.
  virtual void add(const std::string& topic, const std::string& type, std::int64_t time,
                   const BagBytes& message) = 0;
  virtual void finish() = 0;
};

/// How a bag is written.
struct BagStyle {
  std::string format = "bag";         ///< "bag", "mcap" or "db3"
  std::string compression = "none";   ///< of the chunks
  std::size_t messages_in_chunk = 4;  ///< 0, in MCAP: without chunks
  bool finished = true;               ///< or as a recorder leaves it that was killed
};

/// "sensor_msgs/msg/Image" of "sensor_msgs/Image".
inline std::string ros2_type(std::string type) { return type.insert(type.find('/'), "/msg"); }

}  // namespace stillpoint::testing
