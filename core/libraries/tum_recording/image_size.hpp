// What an image file says of its own size.
#pragma once

#include <cstdint>
#include <opencv2/core/types.hpp>
#include <optional>
#include <span>

namespace stillpoint::tum_recording {

/// Of a PNG or JPEG file, from its header; nothing for other kinds and damaged headers. A few bytes
/// can state gigabytes, so this is asked before anything is decoded.
std::optional<cv::Size> stated_size(std::span<const std::uint8_t> file);

}  // namespace stillpoint::tum_recording
