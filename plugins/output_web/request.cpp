#include "output_web/request.hpp"

#include "output_web/message_writer.hpp"

namespace stillpoint::output_web {

std::optional<Request> parse_request(std::span<const std::uint8_t> message) {
  constexpr std::uint8_t kAsk = 1;
  if (message.size() != kRequestSize || message[0] != kProtocol || message[1] != kAsk)
    return std::nullopt;
  const std::uint8_t bits = message[2];
  if (bits > 7) return std::nullopt;
  return Request{.image = (bits & 1) != 0, .map = (bits & 2) != 0, .cloud = (bits & 4) != 0};
}

}  // namespace stillpoint::output_web
