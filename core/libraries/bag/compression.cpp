#include "bag/compression.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

namespace stillpoint::bag {
namespace {

/// Room for what comes out. It grows with what came: a stated size may be anything.
class GrowingBuffer {
 public:
  explicit GrowingBuffer(std::size_t most) : most_(most) {}

  /// The free part; empty when there are `most` bytes.
  std::span<std::uint8_t> room() {
    constexpr std::size_t kFirst = 1 << 16;
    if (used_ == bytes_.size()) bytes_.resize(std::min(most_, std::max(kFirst, 2 * bytes_.size())));
    return std::span(bytes_).subspan(used_);
  }
  void add(std::size_t count) { used_ += count; }

  std::vector<std::uint8_t> taken() {
    bytes_.resize(used_);
    return std::move(bytes_);
  }

 private:
  std::size_t most_;
  std::size_t used_ = 0;
  std::vector<std::uint8_t> bytes_;
};

constexpr const char* kTooLong = "it holds more than it says";
constexpr const char* kEndsEarly = "it ends too early";

/// `step(in, out)` reads and fills, says how much of either it used, and whether it is done or
/// failed.
struct Step {
  std::size_t read = 0;
  std::size_t written = 0;
  bool done = false;
  std::string fault = {};
};

template <class Function>
Decompressed run(ByteSpan bytes, std::size_t most, Function step) {
  GrowingBuffer buffer(most);
  std::string fault;
  for (bool done = false; !done && fault.empty();) {
    const auto room = buffer.room();
    std::uint8_t beyond = 0;  // so that the end of the data is seen when the room is full
    const Step taken = step(bytes, room.empty() ? std::span(&beyond, 1) : room);
    bytes = bytes.subspan(taken.read);
    fault = taken.fault;
    done = taken.done;
    if (room.empty() && taken.written > 0) fault = kTooLong;
    if (!room.empty()) buffer.add(taken.written);
    if (!done && fault.empty() && taken.read == 0 && taken.written == 0) fault = kEndsEarly;
  }
  return {buffer.taken(), fault};
}

Decompressed decompress_bzip2(ByteSpan bytes, std::size_t most) {
  bz_stream stream = {};
  if (BZ2_bzDecompressInit(&stream, 0, 0) != BZ_OK) return {{}, "no memory for bzip2"};
  const std::unique_ptr<bz_stream, int (*)(bz_stream*)> owner(&stream, BZ2_bzDecompressEnd);
  return run(bytes, most, [&](ByteSpan in, std::span<std::uint8_t> out) {
    stream.next_in = const_cast<char*>(reinterpret_cast<const char*>(in.data()));
    stream.avail_in = static_cast<unsigned>(in.size());
    stream.next_out = reinterpret_cast<char*>(out.data());
    stream.avail_out = static_cast<unsigned>(out.size());
    const int code = BZ2_bzDecompress(&stream);
    const bool failed = code != BZ_OK && code != BZ_STREAM_END;
    return Step{in.size() - stream.avail_in, out.size() - stream.avail_out, code == BZ_STREAM_END,
                failed ? "damaged bzip2 data" : ""};
  });
}

Decompressed decompress_lz4(ByteSpan bytes, std::size_t most) {
  LZ4F_dctx* created = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&created, LZ4F_VERSION)))
    return {{}, "no memory for LZ4"};
  const std::unique_ptr<LZ4F_dctx, LZ4F_errorCode_t (*)(LZ4F_dctx*)> context(
      created, LZ4F_freeDecompressionContext);
  return run(bytes, most, [&](ByteSpan in, std::span<std::uint8_t> out) {
    std::size_t read = in.size();
    std::size_t written = out.size();
    const std::size_t code =
        LZ4F_decompress(context.get(), out.data(), &written, in.data(), &read, nullptr);
    if (LZ4F_isError(code))
      return Step{0, 0, false, std::string("damaged LZ4 data, ") + LZ4F_getErrorName(code)};
    return Step{read, written, code == 0};
  });
}

Decompressed decompress_zstd(ByteSpan bytes, std::size_t most) {
  const std::unique_ptr<ZSTD_DStream, std::size_t (*)(ZSTD_DStream*)> stream(ZSTD_createDStream(),
                                                                             ZSTD_freeDStream);
  if (!stream) return {{}, "no memory for zstd"};
  return run(bytes, most, [&](ByteSpan in, std::span<std::uint8_t> out) {
    ZSTD_inBuffer input{in.data(), in.size(), 0};
    ZSTD_outBuffer output{out.data(), out.size(), 0};
    const std::size_t code = ZSTD_decompressStream(stream.get(), &output, &input);
    if (ZSTD_isError(code))
      return Step{0, 0, false, std::string("damaged zstd data, ") + ZSTD_getErrorName(code)};
    return Step{input.pos, output.pos, code == 0};
  });
}

}  // namespace

std::optional<Compression> compression_named(std::string_view name) {
  if (name.empty() || name == "none") return Compression::kNone;
  if (name == "bz2") return Compression::kBzip2;
  if (name == "lz4") return Compression::kLz4;
  if (name == "zstd") return Compression::kZstd;
  return std::nullopt;
}

Decompressed decompress(Compression compression, ByteSpan bytes, std::size_t most) {
  switch (compression) {
    case Compression::kBzip2:
      return decompress_bzip2(bytes, most);
    case Compression::kLz4:
      return decompress_lz4(bytes, most);
    case Compression::kZstd:
      return decompress_zstd(bytes, most);
    case Compression::kNone:
      break;
  }
  const ByteSpan copied = bytes.first(std::min(most, bytes.size()));
  return {{copied.begin(), copied.end()}, bytes.size() > most ? kTooLong : ""};
}

bool is_zstd(ByteSpan bytes) {
  constexpr std::uint8_t kMagic[] = {0x28, 0xb5, 0x2f, 0xfd};
  return bytes.size() >= 4 && std::equal(std::begin(kMagic), std::end(kMagic), bytes.begin());
}

ByteSpan MessageBytes::first(std::size_t at_most, const std::string& where,
                             const std::function<ByteSpan(std::size_t)>& stored) {
  constexpr std::size_t kMagic = 4;          // bytes
  constexpr std::size_t kLargest = 1 << 30;  // bytes; larger ones are damage
  const ByteSpan begin = stored(std::max(at_most, kMagic));
  if (!is_zstd(begin)) return begin.first(std::min(at_most, begin.size()));
  Decompressed result =
      decompress(Compression::kZstd, stored(kLargest), std::min(at_most, kLargest));
  if (!result.fault.empty() && result.bytes.size() < at_most)
    throw Error(Fault::kData, "the compressed message is damaged: " + result.fault, where);
  decompressed_ = std::move(result.bytes);
  return decompressed_;
}

}  // namespace stillpoint::bag
