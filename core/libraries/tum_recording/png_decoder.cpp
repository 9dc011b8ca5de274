#include "tum_recording/png_decoder.hpp"

#include <libdeflate.h>

#include <opencv2/core/hal/interface.h>
#include <algorithm>
#include <cstring>
#include <new>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <string_view>

namespace stillpoint::tum_recording {
namespace {

constexpr std::uint8_t kSignature[] = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
constexpr std::size_t kPadding = 8;  // bytes that loads and stores of whole words may touch
constexpr std::uint32_t kMaxSide = 16384;

std::uint32_t big_endian(const std::uint8_t* bytes) {
  return std::uint32_t{bytes[0]} << 24 | bytes[1] << 16 | bytes[2] << 8 | bytes[3];
}

/// Adds four bytes at once, each modulo 256.
std::uint32_t add_bytes(std::uint32_t a, std::uint32_t b) {
  return ((a & 0x7f7f7f7fu) + (b & 0x7f7f7f7fu)) ^ ((a ^ b) & 0x80808080u);
}

// A pixel as four 16-bit numbers; the upper ones are ignored when it has fewer bytes.
using Wide = std::int16_t __attribute__((vector_size(8)));

std::uint32_t load(const std::uint8_t* bytes) {
  std::uint32_t word;
  std::memcpy(&word, bytes, sizeof word);
  return word;
}

void store(std::uint8_t* bytes, std::uint32_t word) { std::memcpy(bytes, &word, sizeof word); }

Wide widen(std::uint32_t word) {
  using Narrow = std::uint8_t __attribute__((vector_size(4)));
  Narrow bytes;
  std::memcpy(&bytes, &word, sizeof word);
  return __builtin_convertvector(bytes, Wide);
}

std::uint32_t narrow(Wide wide) {
  using Narrow = std::uint8_t __attribute__((vector_size(4)));
  const Narrow bytes = __builtin_convertvector(wide, Narrow);
  std::uint32_t word;
  std::memcpy(&word, &bytes, sizeof word);
  return word;
}

/// The neighbour nearest to left + up - corner (PNG specification, 9.4), without branches: with
/// t = 3 corner - left - up, it is the smaller one if t >= larger, the larger one if t <= smaller.
Wide paeth(Wide left, Wide up, Wide corner) {
  const Wide threshold = corner * 3 - (left + up);
  const Wide smaller = left < up ? left : up;
  const Wide larger = left < up ? up : left;
  const Wide nearest = larger <= threshold ? smaller : corner;
  return threshold <= smaller ? larger : nearest;
}

/// Undoes the filter of one row (PNG specification, section 9). Whole words are read and written
/// per pixel of `kBytes`, so every row has kPadding bytes after it; the next pixel overwrites what
/// a store puts there too much.
template <int kBytes>
void unfilter(int filter, const std::uint8_t* in, const std::uint8_t* above, std::uint8_t* out,
              int size) {
  switch (filter) {
    case 0:
      std::copy_n(in, size, out);
      return;
    case 1: {
      std::uint32_t left = 0;
      for (int i = 0; i < size; i += kBytes) store(out + i, left = add_bytes(left, load(in + i)));
      return;
    }
    case 2:
      for (int i = 0; i < size; ++i) out[i] = static_cast<std::uint8_t>(in[i] + above[i]);
      return;
    case 3: {
      Wide left{};
      for (int i = 0; i < size; i += kBytes) {
        left = (widen(load(in + i)) + ((left + widen(load(above + i))) >> 1)) & 255;
        store(out + i, narrow(left));
      }
      return;
    }
    case 4: {
      Wide left{}, corner{};
      for (int i = 0; i < size; i += kBytes) {
        const Wide up = widen(load(above + i));
        left = (widen(load(in + i)) + paeth(left, up, corner)) & 255;
        corner = up;
        store(out + i, narrow(left));
      }
      return;
    }
    default:
      throw std::runtime_error("damaged PNG: unknown filter");
  }
}

void big_endian_16(const std::uint8_t* in, std::uint16_t* out, int pixels) {
  for (int i = 0; i < pixels; ++i)
    out[i] = static_cast<std::uint16_t>(in[2 * i] << 8 | in[2 * i + 1]);
}

}  // namespace

struct PngDecoder::Header {
  int width = 0;
  int height = 0;
  int bits = 0;
  int color = 0;  // 0 gray, 2 RGB
  bool interlaced = false;

  int bytes_per_pixel() const { return (color == 2 ? 3 : 1) * bits / 8; }
  bool supported() const {
    return !interlaced && ((color == 0 && (bits == 8 || bits == 16)) || (color == 2 && bits == 8));
  }
};

void PngDecoder::Deleter::operator()(libdeflate_decompressor* decompressor) const {
  libdeflate_free_decompressor(decompressor);
}

PngDecoder::PngDecoder() : decompressor_(libdeflate_alloc_decompressor()) {
  if (!decompressor_) throw std::bad_alloc();
}
PngDecoder::~PngDecoder() = default;

bool PngDecoder::is_png(std::span<const std::uint8_t> file) {
  return file.size() >= sizeof kSignature &&
         std::equal(std::begin(kSignature), std::end(kSignature), file.begin());
}

/// Verifies all chunks and joins the compressed data.
PngDecoder::Header PngDecoder::collect_chunks(std::span<const std::uint8_t> file) {
  if (!is_png(file)) throw std::runtime_error("no PNG");
  Header header;
  compressed_.clear();
  for (std::size_t at = sizeof kSignature;;) {
    if (file.size() - at < 12) throw std::runtime_error("truncated PNG");
    const std::uint32_t length = big_endian(&file[at]);
    if (file.size() - at - 12 < length) throw std::runtime_error("truncated PNG");
    const std::uint8_t* type = &file[at + 4];
    const std::uint8_t* data = type + 4;
    if (libdeflate_crc32(0, type, length + 4) != big_endian(data + length))
      throw std::runtime_error("damaged PNG: a checksum does not fit");
    const std::string_view name(reinterpret_cast<const char*>(type), 4);
    // The size of an image is looked at where its first chunk says it, before anything is decoded.
    if ((name == "IHDR") != (at == sizeof kSignature))
      throw std::runtime_error("damaged PNG: IHDR is not its first chunk, or not the only one");
    if (name == "IHDR" && length == 13) {
      if (std::max(big_endian(data), big_endian(data + 4)) > kMaxSide)
        throw std::runtime_error("damaged PNG: impossible size");
      header = {.width = static_cast<int>(big_endian(data)),
                .height = static_cast<int>(big_endian(data + 4)),
                .bits = data[8],
                .color = data[9],
                .interlaced = data[12] != 0};
    } else if (name == "IDAT") {
      compressed_.insert(compressed_.end(), data, data + length);
    } else if (name == "IEND") {
      break;
    }
    at += length + 12;
  }
  if (header.width == 0 || header.height == 0) throw std::runtime_error("damaged PNG: no header");
  return header;
}

cv::Mat PngDecoder::decode(std::span<const std::uint8_t> file) {
  const Header header = collect_chunks(file);
  if (!header.supported()) return {};
  const int row_size = header.width * header.bytes_per_pixel();
  const std::size_t size = static_cast<std::size_t>(row_size + 1) * header.height;
  filtered_.resize(size + kPadding);
  std::size_t actual = 0;
  if (libdeflate_zlib_decompress(decompressor_.get(), compressed_.data(), compressed_.size(),
                                 filtered_.data(), size, &actual) != LIBDEFLATE_SUCCESS ||
      actual != size)
    throw std::runtime_error("damaged PNG: its data cannot be decompressed");

  for (auto& row : rows_) row.assign(row_size + kPadding, 0);
  const int type = header.color == 2 ? CV_8UC3 : header.bits == 16 ? CV_16UC1 : CV_8UC1;
  cv::Mat image(header.height, header.width, type);
  const auto undo = header.color == 2 ? unfilter<3> : header.bits == 16 ? unfilter<2> : unfilter<1>;
  for (int y = 0; y < header.height; ++y) {
    const std::uint8_t* in = &filtered_[static_cast<std::size_t>(row_size + 1) * y];
    std::uint8_t* row = rows_[y % 2].data();
    undo(in[0], in + 1, rows_[1 - y % 2].data(), row, row_size);
    if (type == CV_16UC1)
      big_endian_16(row, image.ptr<std::uint16_t>(y), header.width);
    else
      std::copy_n(row, row_size, image.ptr(y));
  }
  if (type == CV_8UC3) cv::cvtColor(image, image, cv::COLOR_RGB2BGR);
  return image;
}

}  // namespace stillpoint::tum_recording
