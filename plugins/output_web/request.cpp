#include "output_web/request.hpp"

#include "output_web/message_writer.hpp"

namespace stillpoint::output_web {

std::optional<std::variant<Request, Command>> parse_request(std::span<const std::uint8_t> message) {
  constexpr std::uint8_t kAsk = 1, kDo = 2;
  if (message.size() != kRequestSize || message[0] != kProtocol) return std::nullopt;
  const std::uint8_t what = message[2];
  if (message[1] == kAsk && what < 16)
    return Request{.image = (what & 1) != 0,
                   .map = (what & 2) != 0,
                   .cloud = (what & 4) != 0,
                   .voxels = (what & 8) != 0};
  constexpr auto kFirst = static_cast<std::uint8_t>(Command::kPause);
  constexpr auto kLast = static_cast<std::uint8_t>(Command::kSaveMap);
  if (message[1] == kDo && what >= kFirst && what <= kLast) return static_cast<Command>(what);
  return std::nullopt;
}

}  // namespace stillpoint::output_web
