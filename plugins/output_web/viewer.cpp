#include "output_web/viewer.hpp"

#include <chrono>
#include <utility>

namespace stillpoint::output_web {
namespace {

namespace beast = boost::beast;
namespace websocket = beast::websocket;
using boost::system::error_code;

constexpr auto kIdleTime = std::chrono::seconds(30);  // until one that answers no pings has gone
// After a request that came before the answer to the one before: requests without end make the
// server look for news ten times per second, not more.
constexpr auto kAfterEarlyRequest = std::chrono::milliseconds(100);

}  // namespace

Viewer::Viewer(ServerLoop& loop, beast::tcp_stream stream)
    : loop_(loop), socket_(std::move(stream)) {
  loop_.enter(*this);
}

void Viewer::start(const beast::http::request<beast::http::empty_body>& request) {
  beast::get_lowest_layer(socket_).expires_never();  // the socket has time limits of its own
  socket_.set_option(websocket::stream_base::timeout{
      .handshake_timeout = kRequestTime, .idle_timeout = kIdleTime, .keep_alive_pings = true});
  socket_.read_message_max(kRequestSize);
  socket_.binary(true);
  socket_.auto_fragment(false);  // frames of 4 kB take twice to nine times the processor time
  socket_.async_accept(request, [self = shared_from_this()](error_code error) {
    if (error) return;
    self->open_ = true;
    self->read();
  });
}

void Viewer::offer() {
  if (!asked_) return;
  if (asked_->voxels) loop_.read_dense_map();
  send(*asked_);
}

void Viewer::close_gracefully() {
  if (!open_) return beast::get_lowest_layer(socket_).cancel();
  send({.image = true, .map = true, .cloud = true, .voxels = wants_voxels_});
  if (!writing_) close(websocket::close_code::going_away);
}

void Viewer::read() {
  socket_.async_read(buffer_, [self = shared_from_this()](error_code error, std::size_t) {
    if (!error) self->take_request();
  });
}

void Viewer::read_later() {
  read_timer_.expires_after(kAfterEarlyRequest);
  read_timer_.async_wait([self = shared_from_this()](error_code error) {
    if (!error) self->read();
  });
}

void Viewer::take_request() {
  const auto bytes = buffer_.cdata();
  const auto said = parse_request({static_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
  buffer_.consume(buffer_.size());
  if (!said || !socket_.got_binary()) return close(websocket::close_code::policy_error);
  if (const auto* command = std::get_if<Command>(&*said)) {
    if (!loop_.execute(*this, *command)) return close(websocket::close_code::policy_error);
  } else {
    const bool is_early = asked_.has_value();
    asked_ = std::get<Request>(*said);
    wants_voxels_ = asked_->voxels;
    offer();
    if (is_early) return read_later();
  }
  read();
}

void Viewer::send(const Request& request) {
  if (writing_ || closed_) return;
  try {
    message_ = loop_.events().news(seen_, request);
  } catch (const std::exception& error) {
    loop_.warn(std::string("a viewer was dropped: ") + error.what());
    return close(websocket::close_code::internal_error);
  }
  if (message_.empty()) return;
  writing_ = true;
  asked_.reset();
  socket_.async_write(boost::asio::buffer(message_),
                      [self = shared_from_this()](error_code error, std::size_t) {
                        if (!error) self->written();
                      });
}

void Viewer::written() {
  writing_ = false;
  if (loop_.is_closing()) return close_gracefully();
  offer();
}

void Viewer::close(websocket::close_code reason) {
  if (std::exchange(closed_, true)) return;
  socket_.async_close(reason, [self = shared_from_this()](error_code) {});
}

}  // namespace stillpoint::output_web
