#include "ros2_messages/compression.hpp"

#include <lz4frame.h>
#include <zstd.h>

#include <string>

#include "stillpoint/error.hpp"

namespace stillpoint::ros2_messages {
namespace {

[[noreturn]] void fail(const char* reason) {
  throw Error(Fault::kStage, std::string("a chunk cannot be compressed: ") + reason);
}

Bytes with_lz4(const Bytes& data) {
  LZ4F_preferences_t preferences = LZ4F_INIT_PREFERENCES;
  preferences.frameInfo.contentSize = data.size();
  Bytes result(LZ4F_compressFrameBound(data.size(), &preferences));
  const std::size_t size =
      LZ4F_compressFrame(result.data(), result.size(), data.data(), data.size(), &preferences);
  if (LZ4F_isError(size)) fail(LZ4F_getErrorName(size));
  result.resize(size);
  return result;
}

Bytes with_zstd(const Bytes& data) {
  constexpr int kFast = 1;
  Bytes result(ZSTD_compressBound(data.size()));
  const std::size_t size =
      ZSTD_compress(result.data(), result.size(), data.data(), data.size(), kFast);
  if (ZSTD_isError(size)) fail(ZSTD_getErrorName(size));
  result.resize(size);
  return result;
}

}  // namespace

const char* name_of(Compression compression) {
  switch (compression) {
    case Compression::kLz4:
      return "lz4";
    case Compression::kZstd:
      return "zstd";
    case Compression::kNone:
      break;
  }
  return "";
}

Bytes compressed(const Bytes& data, Compression compression) {
  switch (compression) {
    case Compression::kLz4:
      return with_lz4(data);
    case Compression::kZstd:
      return with_zstd(data);
    case Compression::kNone:
      break;
  }
  return data;
}

}  // namespace stillpoint::ros2_messages
