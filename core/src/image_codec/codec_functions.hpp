// What the library of image codecs exports. Exceptions pass: it is compiled together with its
// caller.
#pragma once

#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <span>
#include <string>
#include <vector>

namespace stillpoint {

using DecodeImage = cv::Mat(std::span<const std::uint8_t> file, int imread_flags);
using EncodeImage = std::vector<std::uint8_t>(const std::string& extension, const cv::Mat& image,
                                              const std::vector<int>& imwrite_options);

struct CodecFunctions {
  DecodeImage* decode = nullptr;
  EncodeImage* encode = nullptr;
};

constexpr const char* kCodecLibrary = "libstillpoint_image_codec.so";
constexpr const char* kCodecSymbol = "stillpoint_image_codec";

}  // namespace stillpoint
