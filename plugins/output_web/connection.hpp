// One HTTP request: the page, or a viewer's beginning.
#pragma once

#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "output_web/server_loop.hpp"

namespace stillpoint::output_web {

/// Lives as long as something of it is under way.
class Connection : public std::enable_shared_from_this<Connection> {
 public:
  Connection(ServerLoop& loop, boost::asio::ip::tcp::socket socket);
  ~Connection() { loop_.leave(*this); }
  Connection(const Connection&) = delete;
  Connection& operator=(const Connection&) = delete;

  void start();
  void cancel() { stream_.cancel(); }

 private:
  void answer();
  void respond(boost::beast::http::status status, std::string_view text,
               const char* type = "text/plain; charset=utf-8");

  static constexpr std::uint32_t kHeaderLimit = 8192;  // bytes of a request

  ServerLoop& loop_;
  boost::beast::tcp_stream stream_;
  boost::beast::flat_buffer buffer_{kHeaderLimit};
  boost::beast::http::request_parser<boost::beast::http::empty_body> parser_;
  std::optional<boost::beast::http::response<boost::beast::http::span_body<const char>>> response_;
};

}  // namespace stillpoint::output_web
