// Image files of tests.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core/mat.hpp>
#include <stdexcept>
#include <vector>

#include "stillpoint/error.hpp"
#include "stillpoint/support/image_codec.hpp"
#include "stillpoint/support/image_file.hpp"

namespace stillpoint::testing {

/// Empty when it cannot be read.
inline cv::Mat read_image(const std::filesystem::path& file, int imread_flags = cv::IMREAD_COLOR) {
  try {
    return decode_image(read_image_file(file), imread_flags);
  } catch (const Error& error) {
    if (error.fault() != Fault::kData) throw;
    return {};
  }
}

inline void write_image(const std::filesystem::path& file, const cv::Mat& image) {
  const std::vector<std::uint8_t> bytes = encode_image(file.extension().string(), image);
  std::ofstream out(file, std::ios::binary);
  out.write(reinterpret_cast<const char*>(bytes.data()),
            static_cast<std::streamsize>(bytes.size()));
  if (!out.flush()) throw std::runtime_error("cannot write " + file.string());
}

}  // namespace stillpoint::testing
