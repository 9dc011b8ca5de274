// What browsers send to the live view, and whoever else finds its port.
#include <fstream>
#include <memory>
#include <string>

#include "fuzz/fuzz_target.hpp"
#include "output_web/access.hpp"
#include "output_web/request.hpp"
#include "output_web/test_viewer.hpp"
#include "output_web/web_output.hpp"
#include "stillpoint/testing/test_recording.hpp"

namespace stillpoint::testing {
namespace {

FuzzTarget live_request() {
  return {.seeds = {{output_web::kProtocol, 1, 15}, {output_web::kProtocol, 2, 5}},
          .parse = [](const fs::path& file) { output_web::parse_request(bytes_of(file)); }};
}

/// Target, host and origin, a line each.
FuzzTarget live_access() {
  return {.seeds = {bytes_of_text("/live?token=s3cret\nlocalhost:8080\nhttp://localhost:8080"),
                    bytes_of_text("/?a=b&token=s3cret\n[::1]:8080\nhttps://[::1]:8080")},
          .parse =
              [](const fs::path& file) {
                std::ifstream stream(file);
                std::string target, host, origin;
                std::getline(stream, target);
                std::getline(stream, host);
                std::getline(stream, origin);
                for (const char* address : {"127.0.0.1", "0.0.0.0"})
                  output_web::Access(address, "s3cret")
                      .refusal({.target = target, .host = host, .origin = origin});
              },
          .words = {"token=", "&", "?", "localhost", "[", "]", ":", "http://", "127.0.0.1"}};
}

/// Whatever a stranger sends, to a server of which the next one asks again.
FuzzTarget live_connection() {
  const auto output = std::make_shared<output_web::WebOutput>(
      output_web::WebOutput::Options{.port = 0}, test_context());
  const std::string upgrade =
      "GET /live HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
      "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n";
  const std::string ask =
      std::string("\x82\x83\0\0\0\0", 6) + static_cast<char>(output_web::kProtocol) + "\x01\x07";
  return {.seeds = {bytes_of_text(upgrade + ask),
                    bytes_of_text("HEAD / HTTP/1.1\r\nHost: localhost\r\n\r\n")},
          .parse =
              [output](const fs::path& file) {
                const Bytes bytes = bytes_of(file);
                output_web::TestConnection connection(output_web::port_of(output->url()));
                connection.send({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
                connection.end();
                connection.rest();
              },
          .words = {"\r\n", ": ", "Upgrade", "Content-Length: ", "Transfer-Encoding: chunked",
                    "HTTP/1.1", "Sec-WebSocket-Extensions: permessage-deflate", "\x88", "\x89",
                    "\xff"}};
}

}  // namespace

std::vector<NamedFuzzTarget> live_view_targets() {
  return {{"LiveRequest", live_request},
          {"LiveAccess", live_access},
          {"LiveConnection", live_connection}};
}

}  // namespace stillpoint::testing
