#include "output_web/connection.hpp"

#include <chrono>
#include <utility>

#include "output_web/viewer.hpp"

namespace stillpoint::output_web {
namespace {

namespace http = boost::beast::http;
using boost::asio::ip::tcp;
using boost::system::error_code;

constexpr auto kPageTime = std::chrono::minutes(2);  // over a slow network

// The page has all of itself within: nothing is loaded from elsewhere.
constexpr const char* kContentPolicy =
    "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
    "img-src data: blob:; connect-src 'self'; base-uri 'none'; frame-ancestors 'none'";

std::string_view view_of(boost::beast::string_view text) { return {text.data(), text.size()}; }

}  // namespace

Connection::Connection(ServerLoop& loop, tcp::socket socket)
    : loop_(loop), stream_(std::move(socket)) {
  loop_.enter(*this);
}

void Connection::start() {
  stream_.expires_after(kRequestTime);
  parser_.header_limit(kHeaderLimit);
  parser_.body_limit(std::uint64_t{0});
  http::async_read(stream_, buffer_, parser_,
                   [self = shared_from_this()](error_code error, std::size_t) {
                     if (!error) self->answer();
                   });
}

void Connection::answer() {
  const auto& request = parser_.get();
  const std::string_view target = view_of(request.target());
  const std::string_view refusal =
      loop_.setup().access.refusal({.target = target,
                                    .host = view_of(request[http::field::host]),
                                    .origin = view_of(request[http::field::origin])});
  if (!refusal.empty()) return respond(http::status::forbidden, refusal);
  const bool is_viewer = path_of(target) == "/live";
  if (is_viewer && loop_.is_full())  // also to a page that was refused, and asks why
    return respond(http::status::service_unavailable, "as many viewers as the run allows");
  if (is_viewer && boost::beast::websocket::is_upgrade(request))
    return std::make_shared<Viewer>(loop_, std::move(stream_))->start(request);
  if (request.method() != http::verb::get && request.method() != http::verb::head)
    return respond(http::status::method_not_allowed, "only GET");
  if (path_of(target) != "/") return respond(http::status::not_found, "there is only /");
  respond(http::status::ok, loop_.setup().page, "text/html; charset=utf-8");
}

void Connection::respond(http::status status, std::string_view text, const char* type) {
  response_.emplace();
  response_->result(status);
  response_->set(http::field::content_type, type);
  response_->set(http::field::cache_control, "no-store");
  response_->set("Content-Security-Policy", kContentPolicy);
  response_->set("X-Content-Type-Options", "nosniff");
  response_->set("Referrer-Policy", "no-referrer");  // the address may have the token
  response_->content_length(text.size());
  response_->keep_alive(false);
  if (parser_.get().method() != http::verb::head) response_->body() = {text.data(), text.size()};
  stream_.expires_after(kPageTime);
  http::async_write(stream_, *response_, [self = shared_from_this()](error_code, std::size_t) {
    error_code ignored;
    self->stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  });
}

}  // namespace stillpoint::output_web
