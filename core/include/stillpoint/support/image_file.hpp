// Image files, looked at before they are decoded: a few bytes can state gigabytes.
#pragma once

#include <cstdint>
#include <filesystem>
#include <opencv2/core/types.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stillpoint/export.hpp"

namespace stillpoint {

/// What the header of a PNG, JPEG, WebP, BMP or PNM file says of its size, unverified; nothing for
/// other kinds and damaged headers. Sides of more than 2^31 - 1 pixels are given as that.
STILLPOINT_EXPORT std::optional<cv::Size> stated_image_size(std::span<const std::uint8_t> file);

/// Throws Error(kData) with `where` when the size of the image cannot be known before it is
/// decoded, or is more than 100 million pixels.
STILLPOINT_EXPORT void require_image_size(std::span<const std::uint8_t> file,
                                          const std::string& where);

/// `bytes`: the file, at most 256 MiB. Throws Error(kData) when it is not there, no regular file
/// (a pipe would be waited for), empty, too large, or require_image_size() throws.
STILLPOINT_EXPORT void read_image_file(const std::filesystem::path& file,
                                       std::vector<std::uint8_t>& bytes);

inline std::vector<std::uint8_t> read_image_file(const std::filesystem::path& file) {
  std::vector<std::uint8_t> bytes;
  read_image_file(file, bytes);
  return bytes;
}

}  // namespace stillpoint
