// A browser with the page open. It asks, and gets one message.
#pragma once

#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <memory>
#include <optional>
#include <string>

#include "output_web/event_log.hpp"
#include "output_web/server_loop.hpp"

namespace stillpoint::output_web {

/// Lives as long as something of it is under way. Of several requests before an answer, the last
/// one is answered.
class Viewer : public std::enable_shared_from_this<Viewer> {
 public:
  Viewer(ServerLoop& loop, boost::beast::tcp_stream stream);
  ~Viewer() { loop_.leave(*this); }
  Viewer(const Viewer&) = delete;
  Viewer& operator=(const Viewer&) = delete;

  /// `request` has asked to become a WebSocket.
  void start(const boost::beast::http::request<boost::beast::http::empty_body>& request);
  /// Answers if it has asked, and something is new.
  void offer();
  /// Everything that is new, asked for or not, then the end.
  void close_gracefully();

 private:
  void read();
  void read_later();
  void take_request();
  void send(const Request& request);
  void written();
  void close(boost::beast::websocket::close_code reason);

  ServerLoop& loop_;
  boost::beast::websocket::stream<boost::beast::tcp_stream> socket_;
  boost::asio::steady_timer read_timer_{socket_.get_executor()};
  boost::beast::flat_buffer buffer_;
  std::string message_;  // under way
  Seen seen_;
  std::optional<Request> asked_;
  bool wants_voxels_ = false;  // whether the last request asked for the dense map
  bool open_ = false;          // the handshake is over
  bool writing_ = false;
  bool closed_ = false;
};

}  // namespace stillpoint::output_web
