// What a viewer may say.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <variant>

namespace stillpoint::output_web {

/// What a viewer asks for. It gets everything that is new of it, once.
struct Request {
  bool image = false;   ///< the newest image with features, moving points and mask
  bool map = false;     ///< landmarks and key frames
  bool cloud = false;   ///< the surfaces that key frames have seen
  bool voxels = false;  ///< the dense map
};

/// What a viewer makes the run do.
enum class Command : std::uint8_t { kPause = 1, kResume = 2, kStep = 3, kEnd = 4, kSaveMap = 5 };

inline constexpr std::size_t kRequestSize = 3;  // bytes, of either

/// Protocol number, then 1 and one bit per field of a request, or 2 and a command. Nothing for any
/// other message.
std::optional<std::variant<Request, Command>> parse_request(std::span<const std::uint8_t> message);

}  // namespace stillpoint::output_web
