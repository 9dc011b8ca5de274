// What a viewer may say.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>

namespace stillpoint::output_web {

/// What a viewer asks for. It gets everything that is new of it, once.
struct Request {
  bool image = false;  ///< the newest image with features, moving points and mask
  bool map = false;    ///< landmarks and key frames
  bool cloud = false;  ///< the surfaces that key frames have seen
};

inline constexpr std::size_t kRequestSize = 3;  // bytes

/// Protocol number, kind 1, one bit per field above. Nothing for any other message.
std::optional<Request> parse_request(std::span<const std::uint8_t> message);

}  // namespace stillpoint::output_web
