#include "simulation/png_file.hpp"

#include <libdeflate.h>

#include <cstdint>
#include <fstream>
#include <memory>
#include <new>
#include <string_view>
#include <vector>

#include "stillpoint/error.hpp"

// Section numbers are those of the PNG specification, W3C Recommendation, second edition.
namespace stillpoint::simulation {
namespace {

using Bytes = std::vector<std::uint8_t>;

struct Deleter {
  void operator()(libdeflate_compressor* compressor) const {
    libdeflate_free_compressor(compressor);
  }
};

void append_number(Bytes& out, std::uint32_t number) {
  for (const int shift : {24, 16, 8, 0})
    out.push_back(static_cast<std::uint8_t>(number >> static_cast<unsigned>(shift)));
}

/// §5.3
void append_chunk(Bytes& out, std::string_view type, const Bytes& data) {
  append_number(out, static_cast<std::uint32_t>(data.size()));
  const std::size_t start = out.size();
  out.insert(out.end(), type.begin(), type.end());
  out.insert(out.end(), data.begin(), data.end());
  append_number(out, libdeflate_crc32(0, &out[start], out.size() - start));
}

/// §11.2.2
Bytes header(const cv::Mat& image) {
  constexpr std::uint8_t kGray = 0;
  constexpr std::uint8_t kTrueColor = 2;
  Bytes data;
  append_number(data, static_cast<std::uint32_t>(image.cols));
  append_number(data, static_cast<std::uint32_t>(image.rows));
  data.push_back(static_cast<std::uint8_t>(8 * image.elemSize1()));
  data.push_back(image.channels() == 3 ? kTrueColor : kGray);
  data.insert(data.end(), {0, 0, 0});  // deflate, adaptive filters, not interlaced
  return data;
}

/// The bytes of a row in the order of §7.2: red first, the high byte first.
void put_row(const cv::Mat& image, int y, std::uint8_t* out) {
  if (image.type() == CV_16UC1) {
    const auto* in = image.ptr<std::uint16_t>(y);
    for (int x = 0; x < image.cols; ++x) {
      out[2 * x] = static_cast<std::uint8_t>(in[x] >> 8);
      out[2 * x + 1] = static_cast<std::uint8_t>(in[x]);
    }
  } else if (image.type() == CV_8UC3) {
    const auto* in = image.ptr<std::uint8_t>(y);
    for (int i = 0; i < 3 * image.cols; i += 3) {
      out[i] = in[i + 2];
      out[i + 1] = in[i + 1];
      out[i + 2] = in[i];
    }
  } else {
    std::copy_n(image.ptr<std::uint8_t>(y), image.cols, out);
  }
}

/// Each byte less that of the pixel before, modulo 256 (§9.2, Sub): noise of neighbours is cheap
/// to compress then.
Bytes filtered(const cv::Mat& image) {
  constexpr std::uint8_t kSub = 1;
  const std::size_t step = image.elemSize();
  const std::size_t length = step * static_cast<std::size_t>(image.cols);
  Bytes row(length);
  Bytes result((length + 1) * static_cast<std::size_t>(image.rows));
  std::uint8_t* out = result.data();
  for (int y = 0; y < image.rows; ++y, out += length + 1) {
    put_row(image, y, row.data());
    out[0] = kSub;
    std::copy_n(row.data(), step, out + 1);
    for (std::size_t i = step; i < length; ++i)
      out[i + 1] = static_cast<std::uint8_t>(row[i] - row[i - step]);
  }
  return result;
}

std::unique_ptr<libdeflate_compressor, Deleter> make_compressor() {
  constexpr int kFastest = 1;
  std::unique_ptr<libdeflate_compressor, Deleter> compressor(libdeflate_alloc_compressor(kFastest));
  if (!compressor) throw std::bad_alloc();
  return compressor;
}

Bytes compressed(const Bytes& data) {
  // One per thread: making one costs as much as a small image.
  thread_local const auto compressor = make_compressor();
  Bytes result(libdeflate_zlib_compress_bound(compressor.get(), data.size()));
  result.resize(libdeflate_zlib_compress(compressor.get(), data.data(), data.size(), result.data(),
                                         result.size()));
  return result;
}

}  // namespace

void write_png(const std::filesystem::path& file, const cv::Mat& image) {
  Bytes bytes = {0x89, 'P', 'N', 'G', '\r', '\n', 0x1a, '\n'};
  append_chunk(bytes, "IHDR", header(image));
  append_chunk(bytes, "IDAT", compressed(filtered(image)));
  append_chunk(bytes, "IEND", {});
  std::ofstream stream(file, std::ios::binary);
  stream.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  if (!stream.flush())
    throw Error(Fault::kUsage, "cannot write the image", file.string(), "is the disk full?");
}

}  // namespace stillpoint::simulation
